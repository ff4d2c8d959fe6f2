//! A program that is killed while it saves: the old or the new content is there, whole.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use super::Folder;

/// Saves ever higher numbers: in a state file, in a pose, in a joint and as a copy of a program, and changes a variable
/// of which every change is kept. Says which were there at first, and which have been saved.
const PROGRAM: &str = "\
func void main()
    string f = \"points_data.arl\"
    if($I_NAME[99] == \"\") $I_NAME[99] = \"0\"
    print \"begins \",$I[1],\" \",$I[99],\" \",$I_NAME[99]
    int n = $I[1]
    loop
        n++
        for(int i = 1; i <= 99; i++)
            $I[i] = n
        endfor
        $I_NAME[99] = tostr(n)
        savesv(\"I\")
        bool written = savefilepose(f, \"p\", {x n,y n,z n,a n,b n,c n,ej1 n,ej2 n,ej3 n,ej4 n,ej5 n,ej6 n})
        written = savefilejoint(f, \"q\", {n,n,n,n,n,n,n,n,n,n,n,n}) && written
        string recipe = \"even.arl\"
        if(n % 2 == 1) recipe = \"odd.arl\"
        written = savearl(recipe, \"copy.arl\", true) && written
        print \"saved \",n,\" \",written
        waittime 0.001
    endloop
endfunc
";

/// So many times it is killed.
const KILLS: u32 = 240;
/// The data file: what stands before, between and behind the points.
const TAUGHT: [&str; 3] =
    ["// taught on Monday\njoint q = ", " // over the belt\n  pose p = ", " // above the table\n"];

/// A program file that is copied: more than goes to the disk at once.
fn recipe(name: &str) -> String {
    (0..2000).map(|line| format!("// {name}, line {line}\n")).collect()
}

/// The number that all components of a point have; the turn and the configuration, which stay 0, do not count.
#[track_caller]
fn number(point: &str) -> i32 {
    let components = point.strip_prefix('{').and_then(|rest| rest.strip_suffix('}')).expect("a whole point");
    let words: Vec<&str> = components.split(',').filter_map(|word| word.split(' ').next_back()).collect();
    assert!(words.iter().all(|word| *word == words[0] || *word == "0"), "{point}");
    words[0].parse().expect("a number")
}

/// The numbers in both points of the data file, whose other text has stayed.
#[track_caller]
fn points(file: &str) -> [i32; 2] {
    let [before, between, behind] = TAUGHT;
    let inner = file.strip_prefix(before).and_then(|rest| rest.strip_suffix(behind)).expect("the other text stays");
    let (joint, pose) = inner.split_once(between).expect("the text between stays");
    [number(joint), number(pose)]
}

/// The files of a folder that were being written; none where a kill came before the folder was made.
#[cfg(unix)]
fn beside(folder: &Folder, name: &str) -> Vec<String> {
    let files = std::fs::read_dir(folder.path.join(name)).into_iter().flatten();
    let names = files.filter_map(Result::ok).map(|file| file.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".arl-new")).collect()
}

#[cfg(unix)]
#[test]
fn a_kill_leaves_the_old_or_the_new_value_whole() {
    let [before, between, behind] = TAUGHT;
    let (even, odd) = (recipe("even"), recipe("odd"));
    let folder = Folder::new("kill").with("a.arl", PROGRAM).with("even.arl", &even).with("odd.arl", &odd);
    folder.write("points_data.arl", &format!("{before}{{0,0}}{between}{{x 0}}{behind}"));
    folder.arl2rs(&["build", "a.arl", "-o", "a"]).is(0, "");
    let mut delays = 12345_u32;
    let (mut saved, mut named, mut states, mut files) = (0, 0, 0, 0);
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
        assert!(matches!(numbers[..], [a, b, _] if a == b && a >= saved), "{kill}: {first}, but {saved} was saved");
        // What is kept by itself may be a second old, but is never lost.
        assert!(numbers[2] >= named && numbers[2] <= numbers[0] + 1, "{kill}: {first}, but {named} was kept");
        named = numbers[2];
        for line in lines.map_while(Result::ok) {
            // The last line may be cut.
            let Some((number, written)) = line.strip_prefix("saved ").and_then(|rest| rest.split_once(' ')) else {
                continue;
            };
            assert!(!written.starts_with('f'), "{kill}: {line}");
            if written == "true" {
                saved = number.parse().expect("a number");
            }
        }
        child.wait().expect("it has ended");
        // What was being written lies beside its file until the next start.
        let leftover = beside(&folder, "state");
        assert!(leftover.len() <= 2, "{kill}: {leftover:?}, but one was being written, and where the program stood");
        states += leftover.len();
        let leftover = beside(&folder, ".");
        assert!(leftover.len() <= 1, "{kill}: {leftover:?}, but one file was being written");
        files += leftover.len();
        // In each round the pose is saved before the joint, and the joint before the copy.
        let [joint, pose] = points(&folder.read("points_data.arl"));
        assert!(pose >= joint && joint >= saved, "{kill}: {joint} and {pose}, but {saved} was saved");
        if saved > 0 {
            let copy = folder.read("copy.arl");
            assert!(copy == even || copy == odd, "{kill}: {copy}");
            let kept = i32::from(copy == odd);
            assert!(kept == saved % 2 || joint > saved, "{kill}: the copy that was saved as {saved} is lost");
        }
    }
    println!(
        "{KILLS} kills, {saved} rounds saved; {states} kills while a state file was written, {files} others while a file was"
    );
    assert!(
        saved > 0 && named > 0 && states > 0 && files > 0,
        "{saved} {named} {states} {files}: it was killed while it saved"
    );
}
