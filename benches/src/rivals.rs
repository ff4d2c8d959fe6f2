//! The kernels as one would write them in Rust. Whole numbers wrap where ARL's do.

/// Counts the primes below 10000, many times.
pub fn sieve(rounds: i32) -> i32 {
    const SIZE: usize = 10_000;
    let mut found = 0;
    for _ in 0..rounds {
        let mut composite = vec![false; SIZE];
        for i in 2..SIZE {
            if !composite[i] {
                found += 1;
                let mut k = i + i;
                while k < SIZE {
                    composite[k] = true;
                    k += i;
                }
            }
        }
    }
    found
}

/// Multiplies two matrices of 60 by 60, many times.
pub fn matrix(rounds: i32) -> f64 {
    const N: usize = 60;
    let mut a = Box::new([[0.0; N]; N]);
    let mut b = Box::new([[0.0; N]; N]);
    let mut c = Box::new([[0.0; N]; N]);
    for i in 0..N {
        for j in 0..N {
            a[i][j] = ((i * 7 + j * 3) % 11) as f64 / 60.0;
            b[i][j] = ((i * 5 + j * 13) % 17) as f64 / 480.0;
        }
    }
    for _ in 0..rounds {
        for i in 0..N {
            for j in 0..N {
                let mut sum = 0.0;
                for k in 0..N {
                    sum += a[i][k] * b[k][j];
                }
                c[i][j] = sum;
            }
        }
        a.copy_from_slice(&*c);
    }
    let mut trace = 0.0;
    for i in 0..N {
        trace += a[i][i];
    }
    trace
}

fn chain(start: i32) -> i32 {
    let mut n = start;
    let mut steps = 0;
    while n != 1 {
        n = if n % 2 == 0 { n / 2 } else { n.wrapping_mul(3).wrapping_add(1) };
        steps += 1;
    }
    steps
}

/// The longest Collatz chain that starts below a limit.
pub fn collatz(limit: i32) -> i32 {
    let mut longest = 0;
    let mut sum: i32 = 0;
    for start in 1..limit {
        let steps = chain(start);
        sum = sum.wrapping_add(steps);
        longest = longest.max(steps);
    }
    sum.wrapping_mul(1000).wrapping_add(longest)
}

/// CRC-32 of 8 KiB, many times.
pub fn crc(rounds: i32) -> i32 {
    let mut table = [0_u32; 256];
    for i in 0..256_u32 {
        let mut c = i;
        for _ in 0..8 {
            c = if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 };
        }
        table[i as usize] = c;
    }
    let mut data = vec![0_u8; 8192];
    for i in (0..8192).step_by(4) {
        let value = (i as i32).wrapping_mul(1_103_515_245).wrapping_add(12_345);
        data[i..i + 4].copy_from_slice(&value.to_le_bytes());
    }
    let mut sum = 0;
    for round in 0..rounds {
        let mut c = u32::MAX;
        for byte in &data {
            c = table[((c ^ u32::from(*byte)) & 0xff) as usize] ^ (c >> 8);
        }
        c = !c;
        let at = (round % 2048 * 4) as usize;
        data[at..at + 4].copy_from_slice(&c.to_le_bytes());
        sum ^= c;
    }
    sum as i32
}

fn sort_part(data: &mut [i32], first: i32, last: i32) {
    let mut low = first;
    let high = last;
    while low < high {
        if high - low < 16 {
            for i in low + 1..=high {
                let value = data[i as usize];
                let mut k = i - 1;
                while k >= low && data[k as usize] > value {
                    data[k as usize + 1] = data[k as usize];
                    k -= 1;
                }
                data[(k + 1) as usize] = value;
            }
            return;
        }
        let pivot = data[((low + high) / 2) as usize];
        let (mut i, mut k) = (low, high);
        while i <= k {
            while data[i as usize] < pivot {
                i += 1;
            }
            while data[k as usize] > pivot {
                k -= 1;
            }
            if i <= k {
                data.swap(i as usize, k as usize);
                i += 1;
                k -= 1;
            }
        }
        sort_part(data, low, k);
        low = i;
    }
}

/// Sorts 10000 numbers, many times.
pub fn sort(rounds: i32) -> i32 {
    let mut data = vec![0; 10_000];
    let mut seed: i32 = 12_345;
    let mut sum: i32 = 0;
    for _ in 0..rounds {
        for value in &mut data {
            seed = seed.wrapping_mul(1_103_515_245).wrapping_add(12_345);
            *value = seed >> 8;
        }
        sort_part(&mut data, 0, 9999);
        for value in data.iter().step_by(100) {
            sum = sum.wrapping_mul(31).wrapping_add(*value);
        }
    }
    sum
}

/// Builds lines of text from names and numbers.
pub fn text(lines: i32) -> i32 {
    let names = ["gripper", "conveyor", "press", "table"];
    let mut all = String::new();
    let mut sum: i32 = 0;
    for i in 0..lines {
        let mut line = names[(i % 4) as usize].to_string() + " part " + &i.to_string();
        line += if i % 3 == 0 { " rejected" } else { " placed" };
        all += &line;
        all += ";";
        if all.len() > 4000 {
            sum = sum.wrapping_mul(31).wrapping_add(all.len() as i32);
            for k in 0..100 {
                sum = sum.wrapping_mul(7).wrapping_add(i32::from(all.as_bytes()[k * 40]));
            }
            all = String::new();
        }
    }
    sum.wrapping_add(all.len() as i32)
}

/// A Mandelbrot set in fixed-point numbers with 12 bits behind the point.
pub fn fixed(rows: i32) -> i32 {
    let mut sum = 0;
    for row in 0..rows {
        let ci = row.wrapping_mul(8192) / rows - 4096;
        for column in 0..120 {
            let cr = column * 12_288 / 120 - 8192;
            let (mut x, mut y, mut xx, mut yy): (i32, i32, i32, i32) = (0, 0, 0, 0);
            let mut n = 0;
            while n < 100 && xx.wrapping_add(yy) < 16_384 {
                y = (x.wrapping_mul(y) >> 11).wrapping_add(ci);
                x = xx.wrapping_sub(yy).wrapping_add(cr);
                xx = x.wrapping_mul(x) >> 12;
                yy = y.wrapping_mul(y) >> 12;
                n += 1;
            }
            sum = (sum << 1) ^ sum ^ n;
        }
    }
    sum
}

/// As large as the runtime's.
#[derive(Clone, Copy)]
struct Pose {
    x: f64,
    y: f64,
    z: f64,
    _rest: [f64; 10],
}

/// As large as the runtime's.
#[derive(Clone, Copy)]
struct Joint {
    j1: f64,
    j2: f64,
    _rest: [f64; 9],
    j6: f64,
}

fn turn(grid: &mut [Pose], seat: &mut [Joint], middle: Pose, cosine: f64, sine: f64) -> f64 {
    let mut moved = 0.0;
    for (point, seat) in grid.iter_mut().zip(seat) {
        let dx = point.x - middle.x;
        let dy = point.y - middle.y;
        let x = middle.x + dx * cosine - dy * sine;
        let y = middle.y + dx * sine + dy * cosine;
        moved = moved + (x - point.x).abs() + (y - point.y).abs();
        point.x = x;
        point.y = y;
        point.z = point.z * 0.999 + middle.z * 0.001;
        seat.j1 += dx * 0.01;
        if seat.j1 > 170.0 {
            seat.j1 -= 340.0;
        }
        seat.j2 += (point.z - 300.0) * 0.001;
        seat.j6 = seat.j1 - seat.j2;
    }
    moved
}

/// Points of a grid are turned around a middle, step by step.
pub fn structures(rounds: i32) -> f64 {
    let mut grid = Vec::new();
    let mut seat = Vec::new();
    for i in 0..200 {
        let (x, y) = (f64::from(500 + i % 20 * 10), f64::from(i / 20) * 10.0 - 50.0);
        grid.push(Pose { x, y, z: 300.0, _rest: [0.0; 10] });
        seat.push(Joint { j1: 0.0, j2: -90.0, _rest: [0.0; 9], j6: 0.0 });
    }
    let mut middle = Pose { x: 590.0, y: -20.0, z: 410.0, _rest: [0.0; 10] };
    let mut sum = 0.0;
    for _ in 0..rounds {
        middle.x += 0.25;
        middle.y -= 0.125;
        sum += turn(&mut grid, &mut seat, middle, 0.999, 0.0447);
    }
    sum + seat[199].j6 + grid[199].x
}

/// Fibonacci numbers by a function that calls itself.
pub fn fib(n: i32) -> i32 {
    if n < 2 { n } else { fib(n - 1).wrapping_add(fib(n - 2)) }
}

fn place(row: i32, size: i32, columns: i32, up: i32, down: i32) -> i32 {
    if row == size {
        return 1;
    }
    let mut count = 0;
    for i in 0..size {
        let here = 1 << i;
        if (columns | up | down) & here == 0 {
            count += place(row + 1, size, columns | here, (up | here) << 1, (down | here) >> 1);
        }
    }
    count
}

/// Counts the ways to place queens on a board so that none attacks another.
pub fn queens(size: i32) -> i32 {
    place(0, size, 0, 0, 0)
}

enum State {
    Next,
    Accept,
    Reject,
    Hold,
    Release,
}

/// A machine that takes parts apart by weight.
pub fn machine(parts: i32) -> i32 {
    let mut seed: i32 = 1;
    let (mut weight, mut good, mut bad, mut held): (i32, i32, i32, i32) = (0, 0, 0, 0);
    let mut remaining = parts;
    let mut state = State::Next;
    loop {
        state = match state {
            State::Next => {
                if remaining == 0 {
                    break;
                }
                remaining -= 1;
                seed = seed.wrapping_mul(1_103_515_245).wrapping_add(12_345);
                weight = seed >> 16 & 0xff;
                match weight {
                    ..20 => State::Reject,
                    201.. => State::Hold,
                    _ => State::Accept,
                }
            }
            State::Accept => {
                good = good.wrapping_add(weight);
                if held > 3 { State::Release } else { State::Next }
            }
            State::Reject => {
                bad += 1;
                if bad % 8 == 0 { State::Release } else { State::Next }
            }
            State::Hold => {
                held += 1;
                if held < 8 { State::Next } else { State::Release }
            }
            State::Release if held == 0 => State::Next,
            State::Release => {
                held -= 1;
                weight /= 2;
                if weight > 90 { State::Reject } else { State::Accept }
            }
        };
    }
    good.wrapping_mul(31).wrapping_add(bad * 7).wrapping_add(held)
}
