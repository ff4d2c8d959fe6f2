//! The robots that are built in, as robot files: the runtime reads them, the command lists them.

/// Name and text of every built-in robot; the first is the default.
pub const ROBOTS: [(&str, &str); 7] = [
    ("kr10-r1420", include_str!("robots/kr10-r1420.toml")),
    ("kr6-r700", include_str!("robots/kr6-r700.toml")),
    ("irb2400-10", include_str!("robots/irb2400-10.toml")),
    ("tx2-60", include_str!("robots/tx2-60.toml")),
    ("six-10", include_str!("robots/six-10.toml")),
    ("hsr065", include_str!("robots/hsr065.toml")),
    ("cobra600", include_str!("robots/cobra600.toml")),
];
