use arl_rt::arl;
use arl_rt::emit::{Cx, Done};

async fn go(cx: &Cx) -> Done<()> {
    arl!(cx, {
        waittime 1
        movej nowhere
    })
    .await
}

fn main() {}
