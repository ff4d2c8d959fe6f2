mod robot {
    arl_rt::arl!(
        r#"
        func void main()
            print 0bh, nothing
        endfunc
        "#
    );
}

fn main() {}
