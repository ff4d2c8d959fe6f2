mod robot {
    arl_rt::arl! {
        #![delta]
        func void main()
        endfunc
    }
}

mod scara {
    arl_rt::arl! {
        #![scara]
        func void main()
            joint home = {1, 2, 3, 4}
            home.j5 = 1
            movej home
        endfunc
    }
}

fn main() {}
