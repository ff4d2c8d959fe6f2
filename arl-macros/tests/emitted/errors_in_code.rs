// What a crate shows whose build script turns errors into code: the mistakes in ARL, and nothing about `Globals`.
mod robot {
    include!("wrong.rs");
}

fn main() {
    let _ = robot::Globals::new();
}
