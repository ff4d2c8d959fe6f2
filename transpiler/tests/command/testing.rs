//! `test`.

use super::Folder;

#[test]
fn cases_pass_or_show_what_differs() {
    let print = |what: &str| format!("func void main()\n    print {what}\nendfunc\n");
    let folder = Folder::new("test")
        .with("good/out.arl", &print("1 + 1"))
        .with("good/out.out", "2\n")
        .with("good/error.arl", &print("1 + true"))
        .with("good/error.err", "2 bool\n")
        .with("good/alarm.arl", "func void main()\n    int a = 0\n    print 1\n    a = 1 / a\nendfunc\n")
        .with("good/alarm.alarm", "20001 4\n")
        .with("good/alarm.out", "1\n")
        .with("good/io.arl", "func void main()\n    waituntil getdi(3)\n    print \"on\"\nendfunc\n")
        .with("good/io.out", "on\n")
        .with("good/io.io.toml", "[[event]]\nat = 1.0\ndi.3 = true\n")
        .with("good/points.arl", &print("count"))
        .with("good/points_data.arl", "int count = 5\n")
        .with("good/points.out", "5\n")
        .with("good/late.arl", "func void main()\n    waittime 100\nendfunc\n")
        .with("good/late.out", "")
        .with("good/late.toml", "max_time = 1\n")
        .with("bad/out.arl", &print("1 + 1"))
        .with("bad/out.out", "3\n")
        .with("bad/error.arl", &print("1 + true"))
        .with("bad/error.err", "3\n")
        .with("bad/refused.arl", &print("1 + true"))
        .with("bad/refused.out", "2\n")
        .with("bad/alarm.arl", &print("1"))
        .with("bad/alarm.alarm", "* 2\n")
        .with("bad/nothing.arl", &print("1"))
        .with("bad/nothing.toml", "")
        .with("empty/module.arl", "func void f()\nendfunc\n");

    let good = folder.arl2rs(&["test", "good"]);
    assert_eq!(good.is(0, "6 passed, 0 failed\n").err, "");

    let both = folder.arl2rs(&["test", "good", "bad"]);
    assert_eq!(both.code, Some(1));
    assert_eq!(both.out.lines().last(), Some("6 passed, 5 failed"), "{}", both.out);
    let parts = [
        "FAILED bad/alarm.arl\n  an alarm was expected, but it ended",
        "FAILED bad/error.arl\n  other errors than expected (- expected, + came):\n  -3\n  +2 ",
        "FAILED bad/nothing.arl\n  nothing is expected of it",
        "FAILED bad/out.arl\n  other output than expected (- expected, + came):\n  -3\n  +2\n",
        "FAILED bad/refused.arl\n  it does not compile:\n  error[ARL",
    ];
    for part in parts {
        assert!(both.out.contains(part), "`{part}` is not in: {}", both.out);
    }

    folder.arl2rs(&["test", "good", "empty"]).is(2, "").says("empty has no case");
    folder.arl2rs(&["test", "nowhere"]).is(2, "").says("nowhere");
}
