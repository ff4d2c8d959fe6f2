//! A cycle in which no motion is planned, and no time law asked for, allocates nothing by the engine either: it
//! calculates, calls functions, evaluates conditions and runs the actions of events in memory that it has.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests stop where something is wrong")]

use arl_engine::Engine;
use arl_rt::io::Scenario;
use arl_rt::{Captured, Controller, Outcome};
use std::path::Path;

struct Text(&'static str);

impl arl2rs::Sources for Text {
    fn read(&self, path: &Path) -> Result<Vec<u8>, arl2rs::SourceError> {
        if path == Path::new("a.arl") { Ok(self.0.as_bytes().to_vec()) } else { Err(arl2rs::SourceError::Missing) }
    }
}

/// A program that begins when everything has been needed once.
const PROGRAM: &str = "
pose places[3] = {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}, {13, 14, 15, 16, 17, 18}}
int counted = 0
double sums[40]

func int deep(int n)
  if(n <= 0) return 0
  return deep(n - 1) + 1
endfunc

func double shifted(pose p, double by)
  p.x = p.x + by
  sums[counted % 40] = p.x
  return p.x + p.y
endfunc

func void note()
  counted++
endfunc

func void halt()
  stopmove
endfunc

func void resume()
  startmove
endfunc

func void round()
  double grid[4][5]
  for(int i = 0; i < 20; i++)
    grid[i / 5][i % 5] = shifted(places[i % 3], i * 0.5)
  endfor
  int rest = deep(50) % 7
  while(rest > 0)
    rest--
    setdo(rest + 1, getdi(rest + 10) || counted % 2 == 0)
  endwhile
  setao(1, grid[3][4] / 100)
  waittime 0.01
endfunc

func void main()
  interrupt 5, when:getdi(3) && counted >= 0, do:note()
  interrupt 1, when:getdi(1), do:halt()
  interrupt 2, when:getdi(2), do:resume()
  timer interval:0.01, rmode:true, do:note()
  movej j:{60,-90,90,0,30,0},vp:30
  trigger when:P(50), do:note()
  movej j:{-60,-90,90,0,30,0},vp:30
  waituntil getdi(9), maxtime:0.3
  loop
    round()
    if(getdi(9)) break
  endloop
endfunc
";

#[test]
fn cycles_allocate_nothing() {
    let checked = arl2rs::check(Path::new("a.arl"), &Text(PROGRAM), &arl2rs::CheckOptions::default());
    let program = checked.program.unwrap_or_else(|| panic!("{:?}", checked.diagnostics));
    let code = arl2rs::lower::lower(&program).unwrap();
    let scenario = "[[event]]\nat = 0.1\ndi.1 = true\n[[event]]\nat = 0.5\ndi.2 = true\n[[event]]\nat = 0.7\ndi.3 = true\n\
                    [[event]]\nat = 1.2\ndi.3 = false\n[[event]]\nat = 1.3\ndi.3 = true\n[[event]]\nat = 8\ndi.9 = true\n";
    let builder = Controller::builder().output(Captured::new()).scenario(Scenario::parse("s.toml", scenario).unwrap());
    let mut controller = builder.build(Engine::new(code)).unwrap();
    let (mut cycles, mut first) = (0, Vec::new());
    while controller.outcome().is_none() {
        let allocated = allocation_counter::measure(|| {
            controller.step();
        });
        cycles += 1;
        if allocated.count_total > 0 && controller.outcome().is_none() {
            first.push((cycles, controller.place().1, allocated.count_total));
        }
    }
    assert_eq!(controller.outcome(), Some(&Outcome::Ended));
    assert!(cycles > 3_000, "{cycles}");
    // Motions are planned in the first cycles; after that what a statement needs is made when it runs first.
    let late: Vec<_> = first.iter().filter(|(cycle, ..)| *cycle > 60).collect();
    assert!(late.len() <= 1, "the first round alone may allocate: {late:?}");
}
