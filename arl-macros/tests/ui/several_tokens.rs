mod robot {
    arl_rt::arl! {
        func void main()
            int a = 1 +
                2
            string s = "a" + "b"   // größer
            int c = s + "c"
        endfunc
    }
}

fn main() {}
