//! Measures how fast ARL is read and how much memory its tree takes:
//! `cargo run --release -p arl-lang --example parse_speed [-- FILE]`.

use std::time::Instant;

use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, parse, text};

/// A function of typical lines, some 25 bytes each.
const TYPICAL: &str = "\
func int work(int n, double limit)
  pose p1 = {x 911.138, y -5.704, z 739.959, a -178.159, b 43.881, c 2.201}
  joint j1 = {0, -10, 90, 0, 90, 0}
  speed v1 = {per 20, tcp 200}
  int count = 0
  double total = 0.5
  movej j1,vp:50%
  lin p:p1,vl:100mm/s,sl:5mm
  lin p1,v1;T(1),setdo(2,true)
  // approach and grip
  waituntil getdi(6),maxtime:5
  if(count < n && total <= limit)
    count++
    total += count * 2.5
    setdo(3, true)
  elseif(getdi(4))
    print \"count \",count,endl
  else
    waittime 0.2
  endif
  for(int i = 0; i < 10; i++)
    a[i] = b[i] + 1
    p1.x = p1.x + offset
    if(a[i] == 0) break
  endfor
  switch(count)
  case 1:
    tools::grip(1, 20)
  default:
    $DFSPEED = {10,50,5,5,5}
  endswitch
  return count
endfunc
";

/// The resident memory of this process in bytes, where the system tells.
fn resident() -> u64 {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    statm.split_whitespace().nth(1).and_then(|pages| pages.parse::<u64>().ok()).unwrap_or(0) * 4096
}

/// The processor time of this process in seconds, where the system tells (in hundredths).
fn processor_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let behind_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks: f64 = behind_name.split_whitespace().skip(11).take(2).flat_map(str::parse::<f64>).sum();
    ticks / 100.0
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let source = match std::env::args().nth(1) {
        Some(file) => text::decode(&std::fs::read(file)?)?.into_owned(),
        None => TYPICAL.repeat(10_000),
    };
    let lines = source.lines().count();
    println!("{lines} lines, {} bytes", source.len());
    for _ in 0..5 {
        let before = resident();
        let (start, busy) = (Instant::now(), processor_time());
        let mut interner = Interner::new();
        let parsed = parse(&source, &mut interner, ParseOptions::default());
        let (seconds, busy) = (start.elapsed().as_secs_f64(), processor_time() - busy);
        let grown = resident().saturating_sub(before);
        println!(
            "{:.0} lines/s ({:.0} of processor time), {:.1} MB/s, {} errors, memory grown by {:.1} times the source",
            lines as f64 / seconds,
            lines as f64 / busy,
            source.len() as f64 / seconds / 1e6,
            parsed.errors.len(),
            grown as f64 / source.len() as f64,
        );
    }
    Ok(())
}
