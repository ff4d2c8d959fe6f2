use arl_rt::arl;
use arl_rt::emit::{Cx, Done};

async fn go(cx: &Cx, height: f64) -> Done<()> {
    arl!(cx, { print "at ", #height }).await
}

fn main() {}
