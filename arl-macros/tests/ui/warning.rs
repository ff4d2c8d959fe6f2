#![deny(deprecated)]

mod robot {
    arl_rt::arl! {
        func void main()
            int never_read = 1
            print 2
        endfunc
    }
}

fn main() {}
