mod robot {
    arl_rt::arl! {
        func void main()
            int count = 1
            print cuont
            prnt count
        endfunc
    }
}

fn main() {}
