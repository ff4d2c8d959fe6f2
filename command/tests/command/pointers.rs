//! Where a program stood when its run ended is known in the next one.

use super::Folder;

const MOVES: &str = "\
import \"way.arl\"
func void main()
    movej j:{0,-90,90,0,45,0},vp:100%
    way::along()
    waittime 0
    int zero = 0
    print 1 / zero
endfunc
";
const PATH_MODULE: &str = "\
func void along()
    movej j:{10,-90,90,0,45,0},vp:100%
endfunc
";
const SECOND: &str = "\
func void main()
    waittime 0.5
endfunc
";
/// The first channel is asked about the second one before that has run in this run.
const ASKS: &str = "\
func void main()
    print curppfile(2),\" \",curppline(2)
    print curmpfile(1),\" \",curmpline(1),\" \",curppfile(1),\" \",curppline(1)
    movej j:{0,-90,90,0,45,0},vp:100%
    waittime 0
    print curmpfile(1),\" \",curmpline(1),\" \",curppfile(2),\" \",curppline(2)
endfunc
";

#[test]
fn a_run_knows_where_the_one_before_stood() {
    let folder = Folder::new("pointers").with("moves.arl", MOVES).with("way.arl", PATH_MODULE).with("asks.arl", ASKS);
    folder.write("second.arl", SECOND);
    folder.write("third.arl", SECOND);
    folder.write("cell.toml", "[[channel]]\nprogram = \"second.arl\"\n");
    folder.write("other.toml", "[[channel]]\nprogram = \"third.arl\"\n");
    folder.arl2rs(&["run", "moves.arl", "--cell", "cell.toml"]).is(3, "").says("alarm 20001");
    let asks = ["run", "asks.arl", "--cell", "other.toml"];
    let out = "second.arl 2\nway.arl 2 asks.arl 3\nasks.arl 4 third.arl 2\n";
    folder.arl2rs(&asks).is(0, out);
    let out = "third.arl 2\nasks.arl 4 asks.arl 3\nasks.arl 4 third.arl 2\n";
    folder.arl2rs(&asks).is(0, out);
    let kept = folder.read(".arl-state/POINTERS.state");
    folder.write(".arl-state/POINTERS.state", &kept.replace("third", "fourth"));
    folder.arl2rs(&asks).is(3, "").says("POINTERS.state: the file is damaged");
}
