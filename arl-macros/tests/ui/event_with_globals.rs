use arl_rt::arl;
use arl_rt::emit::{Cx, Done};

async fn local(cx: &Cx) -> Done<()> {
    arl!(cx, {
        int limit = counts::most
        interrupt 1, when:getdi(limit), do:setdo(1, true)
    })
    .await
}

async fn global(cx: &Cx) -> Done<()> {
    arl!(cx, {
        interrupt 1, when:getdi(1), do:counts::note()
    })
    .await
}

async fn global_of_a_first_value(cx: &Cx) -> Done<()> {
    arl!(cx, {
        print armed::armed
    })
    .await
}

fn main() {}
