//! ARL in Rust: a whole program, statements with Rust values in them, and a program in a file.

use arl_rt::program::{BoxFuture, Done, File};
use arl_rt::{Captured, Controller, Cx, Family, Program, arl};

/// A whole program.
mod count {
    arl_rt::arl! {
        int pulses                        // how many came

        func int gauss(int n)
            return n * (n + 1) / 2
        endfunc

        func void main()
            for(int i = 1; i <= 4; i++)
                pulsedo(1, true, 0.1)
                waittime 0.25
                pulses = pulses + i
            endfor
            print pulses == gauss(4), " after ", pulses
        endfunc
    }
}

/// A program in a file of its own.
mod greet {
    arl_rt::arl_file!("../robot/greet.arl");
}

/// A program in Rust that uses ARL where that is shorter.
struct Approach {
    heights: Vec<f64>,
}

impl Approach {
    async fn go(&self, cx: &Cx) -> Done<()> {
        arl!(cx, {
            movej j:{0, -90, 90, 0, 90, 0}, vp:50%
            waittime 0                            // until it is there
        })
        .await?;
        let mut number = 0;
        for height in &self.heights {
            number += 1;
            arl!(cx, {
                pose here = cpose()
                here.z = #(*height)
                lin here, vl:#(100.0 + height / 10.0)
                waittime 0
                print "stop ", #(number as int), " at ", cpose().z
            })
            .await?;
        }
        Ok(())
    }
}

impl Program for Approach {
    fn file(&self) -> File {
        File::new(file!())
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(self.go(cx))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("gauss(100) = {}", count::program::gauss(100));
    run(count::Globals::new())?;
    run(greet::Globals::new())?;
    run(Approach { heights: vec![900.0, 700.0] })
}

fn run(program: impl Program + 'static) -> Result<(), Box<dyn std::error::Error>> {
    let messages = Captured::new();
    let mut controller = Controller::builder().output(messages.clone()).build(Box::new(program))?;
    let outcome = controller.run();
    print!("{}", messages.text());
    println!("{outcome:?} after {:.3} s", controller.time());
    Ok(())
}
