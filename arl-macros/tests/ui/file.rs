mod wrong {
    arl_rt::arl_file!("wrong.arl");
}

mod missing {
    arl_rt::arl_file!("missing.arl");
}

mod no_path {
    arl_rt::arl_file!(missing);
}

fn main() {}
