//! A program that is killed while it saves: the old or the new content is there, whole.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use super::Folder;

/// Saves ever higher numbers, in a state file and in a point; says which were there at first, and which have been saved.
const PROGRAM: &str = "\
func void main()
    string f = \"points_data.arl\"
    print \"begins \",$I[1],\" \",$I[99]
    int n = $I[1]
    loop
        n++
        for(int i = 1; i <= 99; i++)
            $I[i] = n
        endfor
        savesv(\"I\")
        bool written = savefilepose(f, \"p\", {x n,y n,z n,a n,b n,c n,ej1 n,ej2 n,ej3 n,ej4 n,ej5 n,ej6 n})
        print \"saved \",n,\" \",written
        waittime 0.001
    endloop
endfunc
";

/// So many times it is killed.
const KILLS: u32 = 200;

#[cfg(unix)]
#[test]
fn a_kill_leaves_the_old_or_the_new_value_whole() {
    const BEFORE: &str = "// taught on Monday\njoint q = {1,2}\n  pose p = ";
    const BEHIND: &str = " // above the table\n";
    let folder = Folder::new("kill").with("a.arl", PROGRAM);
    folder.write("points_data.arl", &format!("{BEFORE}{{x 0}}{BEHIND}"));
    folder.arl2rs(&["build", "a.arl", "-o", "a"]).is(0, "");
    let mut delays = 12345_u32;
    let (mut saved, mut found) = (0, 0);
    for kill in 0..KILLS {
        let mut child = Command::new(folder.path.join("a"))
            .args(["--state-dir", "state", "--script-dir", "."])
            .current_dir(&folder.path)
            .stdout(Stdio::piped())
            .spawn()
            .expect("it starts");
        let mut lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        let first = lines.next().expect("a line").expect("text");
        // Not in step with the program: from within the first saves to some tens of them.
        delays = delays.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        std::thread::sleep(Duration::from_micros(u64::from(delays >> 17)));
        child.kill().expect("it is killed");
        let numbers: Vec<i32> = first.split(' ').skip(1).map(|word| word.parse().expect("a number")).collect();
        assert!(matches!(numbers[..], [a, b] if a == b && a >= saved), "{kill}: {first}, but {saved} was saved");
        for line in lines.map_while(Result::ok) {
            let Some(number) = line.strip_prefix("saved ").and_then(|rest| rest.strip_suffix(" true")) else {
                // The last line may be cut.
                continue;
            };
            saved = number.parse().expect("a number");
        }
        child.wait().expect("it has ended");
        let file = folder.read("points_data.arl");
        let value = file.strip_prefix(BEFORE).and_then(|rest| rest.strip_suffix(BEHIND)).expect("the other text stays");
        let values: Vec<&str> = value
            .trim_matches(['{', '}'])
            .split(',')
            .map(|word| word.split(' ').next_back().expect("a word"))
            .collect();
        let point: i32 = values[0].parse().expect("a number");
        assert!(
            value.ends_with('}') && values.iter().all(|word| *word == values[0] || *word == "0"),
            "{kill}: {value}"
        );
        assert!(point >= saved, "{kill}: {value}, but {saved} was saved");
        found = found.max(point);
    }
    assert!(saved > 0 && found > 0, "it has saved something between the kills");
}
