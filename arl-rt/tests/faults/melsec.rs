//! Clients of a PLC that speaks the MC protocol.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

use arl_rt::Controller;
use arl_rt::emit::*;

use crate::common::{FILE, say};
use crate::manners::{Manner, until_it_goes};
use crate::watch::{Robot, watched};

const HERE: Str = Str::literal("127.0.0.1");
/// How many bytes the request to read registers has.
const REQUEST: usize = 21;
/// Two registers with "abcd".
const ANSWER: &[u8] = b"\xd0\0\0\xff\xff\x03\0\x06\0\0\0abcd";

async fn open(cx: &Cx, plc: &MelsecDev, port: i32) -> Done<()> {
    while !melsec::open(cx, plc, &HERE, port, 255).await.at(FILE, 1)? {
        cx.next_cycle().await;
    }
    Ok(())
}

/// `waituntil read(plc,text,100,4)`
async fn ask(cx: &Cx, plc: &MelsecDev, line: u32) -> Done<Str> {
    let mut text = Str::literal("-");
    while !melsec::read_string(cx, plc, &mut text, 100, 4).await.at(FILE, line)? {
        cx.next_cycle().await;
    }
    Ok(text)
}

/// Answers questions as it should, until nobody asks any more.
fn behave(mut stream: TcpStream) {
    stream.set_nodelay(true).unwrap();
    while stream.read_exact(&mut [0; REQUEST]).is_ok() {
        stream.write_all(ANSWER).unwrap();
    }
}

/// Runs a program that asks twice against one peer, and then, from its beginning again, against one that answers as it
/// should.
fn ask_twice(peer: impl FnOnce(TcpStream) + Send + 'static) -> String {
    watched(|| {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = i32::from(listener.local_addr().unwrap().port());
        let peer = std::thread::spawn(move || {
            peer(listener.accept().unwrap().0);
            behave(listener.accept().unwrap().0);
        });
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            Box::pin(async move {
                let plc = MelsecDev::default();
                open(cx, &plc, port).await?;
                for line in [2, 3] {
                    say(cx, &ask(cx, &plc, line).await?)?;
                }
                melsec::close(cx, &plc).await;
                Ok(())
            })
        });
        let output = robot.run().text();
        assert_eq!(robot.run().text(), "abcd\nabcd\n", "the program goes on");
        drop(robot);
        peer.join().unwrap();
        output
    })
}

#[test]
fn whatever_the_plc_does_the_program_is_informed_and_goes_on() {
    for manner in Manner::ALL {
        let output = ask_twice(move |stream| {
            // A PLC that answers answers the second question, too.
            if manner == Manner::ByteByByte {
                let mut stream = stream;
                stream.set_nodelay(true).unwrap();
                for _ in 0..2 {
                    stream.read_exact(&mut [0; REQUEST]).unwrap();
                    ANSWER.iter().for_each(|byte| stream.write_all(&[*byte]).unwrap());
                }
                return until_it_goes(stream);
            }
            manner.play(stream, REQUEST, ANSWER);
        });
        let expected = match manner {
            Manner::LeavesHalfway => {
                "alarm 20050: read: the connection to the PLC is lost: the other side has closed it (t.arl:2)"
            }
            Manner::Resets => {
                "alarm 20050: read: the connection to the PLC is lost: Connection reset by peer (os error 104) (t.arl:2)"
            }
            Manner::Silent => "alarm 20050: read: the PLC does not answer (t.arl:2)",
            Manner::ByteByByte => "abcd\nabcd\n",
            Manner::Garbage | Manner::Floods => {
                "alarm 20050: read: the other side does not speak the MC protocol (3E, binary) (t.arl:2)"
            }
        };
        assert_eq!(output, expected, "{manner:?}");
    }
}

/// An answer too many would be taken for that of the next question.
#[test]
fn answers_that_nobody_asked_for_are_an_alarm() {
    const TOO_MANY: &str = "abcd\nalarm 20050: read: the PLC has sent more than it was asked for (t.arl:3)";
    let twice = ask_twice(|mut stream| {
        stream.read_exact(&mut [0; REQUEST]).unwrap();
        stream.write_all(&ANSWER.repeat(2)).unwrap();
        until_it_goes(stream);
    });
    assert_eq!(twice, TOO_MANY);
    let flood = ask_twice(|mut stream| {
        stream.read_exact(&mut [0; REQUEST]).unwrap();
        let answers = ANSWER.repeat(4096);
        while stream.write_all(&answers).is_ok() {}
    });
    assert_eq!(flood, TOO_MANY);
}

#[test]
fn an_answer_of_another_length_is_an_alarm() {
    let output = ask_twice(|mut stream| {
        stream.read_exact(&mut [0; REQUEST]).unwrap();
        stream.write_all(b"\xd0\0\0\xff\xff\x03\0\x04\0\0\0ab").unwrap();
        until_it_goes(stream);
    });
    assert_eq!(output, "alarm 20050: read: the PLC sent 2 bytes instead of 4 (t.arl:2)");
}

/// The answer with bytes changed, cut off, doubled or put in, by a number.
fn damaged(seed: u64) -> Vec<u8> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut below = |most: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % most as u64) as usize
    };
    let mut bytes = ANSWER.to_vec();
    for _ in 0..=below(3) {
        let at = below(bytes.len());
        match below(5) {
            0 => bytes.truncate(at + 1),
            1 => bytes.extend_from_within(at..),
            2 => bytes.insert(at, below(256) as u8),
            _ => bytes[at] = below(256) as u8,
        }
    }
    bytes
}

/// The PLC goes after each: what is not an answer, or not all of one, is an alarm; of one that is whole the next
/// question is.
#[test]
fn damaged_answers_are_reported_and_nothing_remains_of_them() {
    for seed in 0..60 {
        let output = ask_twice(move |mut stream| {
            stream.read_exact(&mut [0; REQUEST]).unwrap();
            stream.write_all(&damaged(seed)).unwrap();
        });
        assert!(output.contains("alarm 20050: read: "), "{seed}: {output}");
    }
}

#[test]
fn a_thousand_connections_one_after_the_other() {
    const TIMES: usize = 1000;
    watched(|| {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = i32::from(listener.local_addr().unwrap().port());
        let peer = std::thread::spawn(move || (0..TIMES).for_each(|_| behave(listener.accept().unwrap().0)));
        let mut robot = Robot::new(Controller::builder(), move |cx: &Cx| {
            Box::pin(async move {
                let plc = MelsecDev::default();
                for _ in 0..TIMES {
                    open(cx, &plc, port).await?;
                    if ask(cx, &plc, 2).await? != "abcd" {
                        say(cx, &"wrong")?;
                    }
                    melsec::close(cx, &plc).await;
                }
                Ok(())
            })
        });
        assert_eq!(robot.run().text(), "");
        drop(robot);
        peer.join().unwrap();
    });
}
