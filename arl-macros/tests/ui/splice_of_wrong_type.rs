use arl_rt::arl;
use arl_rt::emit::{Cx, Done};

async fn go(cx: &Cx, name: &str) -> Done<()> {
    arl!(cx, {
        int i = 1
        i = i + #(name.len())
        waittime #name
    })
    .await
}

fn main() {}
