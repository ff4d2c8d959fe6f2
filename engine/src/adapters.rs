// Written from the catalog: `cargo run -p arl-engine --example renew_adapters`.
//! Brings the arguments of built-ins to the functions of the runtime.

use crate::args::Args;
use crate::handles::damaged;
use arl_code::{StructureOperator, Target};
use arl_lang::catalog::{Base, Enum};
use arl_rt::emit::*;

/// Calls a built-in that takes no time.
///
/// # Errors
/// The fault of the built-in.
pub(crate) fn call_now(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match args.site.target {
        Target::Entry(0) => entry_0(cx, args),
        Target::Entry(1) => entry_1(cx, args),
        Target::Entry(3) => entry_3(cx, args),
        Target::Entry(4) => entry_4(cx, args),
        Target::Entry(5) => entry_5(cx, args),
        Target::Entry(6) => entry_6(cx, args),
        Target::Entry(7) => entry_7(cx, args),
        Target::Entry(8) => entry_8(cx, args),
        Target::Entry(9) => entry_9(cx, args),
        Target::Entry(10) => entry_10(cx, args),
        Target::Entry(11) => entry_11(cx, args),
        Target::Entry(12) => entry_12(cx, args),
        Target::Entry(13) => entry_13(cx, args),
        Target::Entry(14) => entry_14(cx, args),
        Target::Entry(15) => entry_15(cx, args),
        Target::Entry(16) => entry_16(cx, args),
        Target::Entry(17) => entry_17(cx, args),
        Target::Entry(18) => entry_18(cx, args),
        Target::Entry(19) => entry_19(cx, args),
        Target::Entry(20) => entry_20(cx, args),
        Target::Entry(21) => entry_21(cx, args),
        Target::Entry(22) => entry_22(cx, args),
        Target::Entry(23) => entry_23(cx, args),
        Target::Entry(24) => entry_24(cx, args),
        Target::Entry(25) => entry_25(cx, args),
        Target::Entry(26) => entry_26(cx, args),
        Target::Entry(27) => entry_27(cx, args),
        Target::Entry(28) => entry_28(cx, args),
        Target::Entry(32) => entry_32(cx, args),
        Target::Entry(33) => entry_33(cx, args),
        Target::Entry(34) => entry_34(cx, args),
        Target::Entry(35) => entry_35(cx, args),
        Target::Entry(41) => entry_41(cx, args),
        Target::Entry(42) => entry_42(cx, args),
        Target::Entry(43) => entry_43(cx, args),
        Target::Entry(44) => entry_44(cx, args),
        Target::Entry(45) => entry_45(cx, args),
        Target::Entry(46) => entry_46(cx, args),
        Target::Entry(47) => entry_47(cx, args),
        Target::Entry(48) => entry_48(cx, args),
        Target::Entry(49) => entry_49(cx, args),
        Target::Entry(50) => entry_50(cx, args),
        Target::Entry(53) => entry_53(cx, args),
        Target::Entry(55) => entry_55(cx, args),
        Target::Entry(56) => entry_56(cx, args),
        Target::Entry(57) => entry_57(cx, args),
        Target::Entry(58) => entry_58(cx, args),
        Target::Entry(59) => entry_59(cx, args),
        Target::Entry(62) => entry_62(cx, args),
        Target::Entry(71) => entry_71(cx, args),
        Target::Entry(72) => entry_72(cx, args),
        Target::Entry(73) => entry_73(cx, args),
        Target::Entry(75) => entry_75(cx, args),
        Target::Entry(76) => entry_76(cx, args),
        Target::Entry(77) => entry_77(cx, args),
        Target::Entry(78) => entry_78(cx, args),
        Target::Entry(79) => entry_79(cx, args),
        Target::Entry(80) => entry_80(cx, args),
        Target::Entry(81) => entry_81(cx, args),
        Target::Entry(82) => entry_82(cx, args),
        Target::Entry(83) => entry_83(cx, args),
        Target::Entry(84) => entry_84(cx, args),
        Target::Entry(85) => entry_85(cx, args),
        Target::Entry(86) => entry_86(cx, args),
        Target::Entry(87) => entry_87(cx, args),
        Target::Entry(88) => entry_88(cx, args),
        Target::Entry(89) => entry_89(cx, args),
        Target::Entry(90) => entry_90(cx, args),
        Target::Entry(95) => entry_95(cx, args),
        Target::Entry(96) => entry_96(cx, args),
        Target::Entry(97) => entry_97(cx, args),
        Target::Entry(98) => entry_98(cx, args),
        Target::Entry(100) => entry_100(cx, args),
        Target::Entry(114) => entry_114(cx, args),
        Target::Entry(117) => entry_117(cx, args),
        Target::Entry(130) => entry_130(cx, args),
        Target::Entry(131) => entry_131(cx, args),
        Target::Entry(132) => entry_132(cx, args),
        Target::Entry(133) => entry_133(cx, args),
        Target::Entry(134) => entry_134(cx, args),
        Target::Entry(135) => entry_135(cx, args),
        Target::Entry(140) => entry_140(cx, args),
        Target::Entry(141) => entry_141(cx, args),
        Target::Entry(142) => entry_142(cx, args),
        Target::Entry(143) => entry_143(cx, args),
        Target::Entry(144) => entry_144(cx, args),
        Target::Entry(145) => entry_145(cx, args),
        Target::Entry(146) => entry_146(cx, args),
        Target::Entry(147) => entry_147(cx, args),
        Target::Entry(148) => entry_148(cx, args),
        Target::Entry(149) => entry_149(cx, args),
        Target::Entry(150) => entry_150(cx, args),
        Target::Entry(151) => entry_151(cx, args),
        Target::Entry(152) => entry_152(cx, args),
        Target::Entry(153) => entry_153(cx, args),
        Target::Entry(154) => entry_154(cx, args),
        Target::Entry(155) => entry_155(cx, args),
        Target::Entry(156) => entry_156(cx, args),
        Target::Entry(168) => entry_168(cx, args),
        Target::Entry(171) => entry_171(cx, args),
        Target::Entry(172) => entry_172(cx, args),
        Target::Entry(173) => entry_173(cx, args),
        Target::Entry(174) => entry_174(cx, args),
        Target::Entry(175) => entry_175(cx, args),
        Target::Entry(176) => entry_176(cx, args),
        Target::Entry(177) => entry_177(cx, args),
        Target::Entry(184) => entry_184(cx, args),
        Target::Entry(187) => entry_187(cx, args),
        Target::Entry(188) => entry_188(cx, args),
        Target::Entry(190) => entry_190(cx, args),
        Target::Entry(191) => entry_191(cx, args),
        Target::Entry(192) => entry_192(cx, args),
        Target::Entry(193) => entry_193(cx, args),
        Target::Entry(194) => entry_194(cx, args),
        Target::Entry(196) => entry_196(cx, args),
        Target::Entry(197) => entry_197(cx, args),
        Target::Entry(199) => entry_199(cx, args),
        Target::Entry(_) => Err(damaged()),
        Target::Operator(operator) => operate(operator, args),
    }
}

/// Calls a built-in that may take longer than its cycle.
///
/// # Errors
/// The fault of the built-in.
pub(crate) async fn call(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let Target::Entry(number) = args.site.target else { return Err(damaged()) };
    match number {
        2 | 29 | 30 | 31 | 36 | 37 | 38 | 39 => group_0(number, cx, args).await,
        40 | 51 | 52 | 54 | 60 | 61 | 63 | 64 => group_1(number, cx, args).await,
        65 | 66 | 67 | 68 | 69 | 70 | 74 | 91 => group_2(number, cx, args).await,
        92 | 93 | 94 | 99 | 101 | 102 | 103 | 104 => group_3(number, cx, args).await,
        105 | 106 | 107 | 108 | 109 | 110 | 111 | 112 => group_4(number, cx, args).await,
        113 | 115 | 116 | 118 | 119 | 120 | 121 | 122 => group_5(number, cx, args).await,
        123 | 124 | 125 | 126 | 127 | 128 | 129 | 136 => group_6(number, cx, args).await,
        137 | 138 | 139 | 157 | 158 | 159 | 160 | 161 => group_7(number, cx, args).await,
        162 | 163 | 164 | 165 | 166 | 167 | 169 | 170 => group_8(number, cx, args).await,
        180 | 181 | 182 | 183 | 185 | 189 | 200 => group_9(number, cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_0(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        2 => entry_2(cx, args).await,
        29 => entry_29(cx, args).await,
        30 => entry_30(cx, args).await,
        31 => entry_31(cx, args).await,
        36 => entry_36(cx, args).await,
        37 => entry_37(cx, args).await,
        38 => entry_38(cx, args).await,
        39 => entry_39(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_1(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        40 => entry_40(cx, args).await,
        51 => entry_51(cx, args).await,
        52 => entry_52(cx, args).await,
        54 => entry_54(cx, args).await,
        60 => entry_60(cx, args).await,
        61 => entry_61(cx, args).await,
        63 => entry_63(cx, args).await,
        64 => entry_64(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_2(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        65 => entry_65(cx, args).await,
        66 => entry_66(cx, args).await,
        67 => entry_67(cx, args).await,
        68 => entry_68(cx, args).await,
        69 => entry_69(cx, args).await,
        70 => entry_70(cx, args).await,
        74 => entry_74(cx, args).await,
        91 => entry_91(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_3(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        92 => entry_92(cx, args).await,
        93 => entry_93(cx, args).await,
        94 => entry_94(cx, args).await,
        99 => entry_99(cx, args).await,
        101 => entry_101(cx, args).await,
        102 => entry_102(cx, args).await,
        103 => entry_103(cx, args).await,
        104 => entry_104(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_4(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        105 => entry_105(cx, args).await,
        106 => entry_106(cx, args).await,
        107 => entry_107(cx, args).await,
        108 => entry_108(cx, args).await,
        109 => entry_109(cx, args).await,
        110 => entry_110(cx, args).await,
        111 => entry_111(cx, args).await,
        112 => entry_112(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_5(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        113 => entry_113(cx, args).await,
        115 => entry_115(cx, args).await,
        116 => entry_116(cx, args).await,
        118 => entry_118(cx, args).await,
        119 => entry_119(cx, args).await,
        120 => entry_120(cx, args).await,
        121 => entry_121(cx, args).await,
        122 => entry_122(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_6(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        123 => entry_123(cx, args).await,
        124 => entry_124(cx, args).await,
        125 => entry_125(cx, args).await,
        126 => entry_126(cx, args).await,
        127 => entry_127(cx, args).await,
        128 => entry_128(cx, args).await,
        129 => entry_129(cx, args).await,
        136 => entry_136(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_7(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        137 => entry_137(cx, args).await,
        138 => entry_138(cx, args).await,
        139 => entry_139(cx, args).await,
        157 => entry_157(cx, args).await,
        158 => entry_158(cx, args).await,
        159 => entry_159(cx, args).await,
        160 => entry_160(cx, args).await,
        161 => entry_161(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_8(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        162 => entry_162(cx, args).await,
        163 => entry_163(cx, args).await,
        164 => entry_164(cx, args).await,
        165 => entry_165(cx, args).await,
        166 => entry_166(cx, args).await,
        167 => entry_167(cx, args).await,
        169 => entry_169(cx, args).await,
        170 => entry_170(cx, args).await,
        _ => Err(damaged()),
    }
}

async fn group_9(number: u16, cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match number {
        180 => entry_180(cx, args).await,
        181 => entry_181(cx, args).await,
        182 => entry_182(cx, args).await,
        183 => entry_183(cx, args).await,
        185 => entry_185(cx, args).await,
        189 => entry_189(cx, args).await,
        200 => entry_200(cx, args).await,
        _ => Err(damaged()),
    }
}

/// An operator on structures.
fn operate(operator: StructureOperator, args: &mut Args<'_>) -> Result<(), Fault> {
    match operator {
        StructureOperator::AddJoints => {
            let value = args.get::<Joint>(0)? + args.get::<Joint>(1)?;
            args.result(&value)
        }
        StructureOperator::SubtractJoints => {
            let value = args.get::<Joint>(0)? - args.get::<Joint>(1)?;
            args.result(&value)
        }
        StructureOperator::NegateJoint => {
            let value = -args.get::<Joint>(0)?;
            args.result(&value)
        }
        StructureOperator::FrameByFrame => {
            let value = args.get::<Frame>(0)? * args.get::<Frame>(1)?;
            args.result(&value)
        }
        StructureOperator::FrameByPose => {
            let value = args.get::<Frame>(0)? * args.get::<Pose>(1)?;
            args.result(&value)
        }
        StructureOperator::PoseByFrame => {
            let value = args.get::<Pose>(0)? * args.get::<Frame>(1)?;
            args.result(&value)
        }
        StructureOperator::PoseByPose => {
            let value = args.get::<Pose>(0)? * args.get::<Pose>(1)?;
            args.result(&value)
        }
    }
}

/// A `jump` that is to stop above its target.
///
/// # Errors
/// The code is damaged.
pub(crate) fn jump(args: &mut Args<'_>) -> Result<motion::Jump, Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let call = motion::jump(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vp(args.get::<f64>(n)?),
            3 => call = call.t(args.get::<Tool>(n)?),
            4 => call = call.w(&args.get::<Wobj>(n)?),
            5 => call = call.a(args.get::<f64>(n)?),
            6 => call = call.b(args.get::<f64>(n)?),
            7 => call = call.z(args.get::<f64>(n)?),
            8 => call = call.ctr(args.get::<Control>(n)?),
            9 => call = call.s(args.get::<bool>(n)?),
            _ => {}
        }
    }
    Ok(call)
}

/// `abs`
fn entry_0(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = math::abs_int(v0);
    args.result(&done)
}

/// `abs`
fn entry_1(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::abs_double(v0);
    args.result(&done)
}

/// `accept`
async fn entry_2(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = socket::accept(cx, h0.socket()?, &*v1, v2).await?;
    args.result(&done)
}

/// `acos`
fn entry_3(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::acos(v0)?;
    args.result(&done)
}

/// `asin`
fn entry_4(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::asin(v0)?;
    args.result(&done)
}

/// `assert`
fn entry_5(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<bool>(args.at(0)?)?;
    let done = flow::assert(v0)?;
    let () = done;
    Ok(())
}

/// `atan`
fn entry_6(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::atan(v0);
    args.result(&done)
}

/// `atan2`
fn entry_7(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let done = math::atan2(v0, v1);
    args.result(&done)
}

/// `bitcheck`
fn entry_8(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitcheck_byte(v0, v1)?;
    args.result(&done)
}

/// `bitcheck`
fn entry_9(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitcheck_int(v0, v1)?;
    args.result(&done)
}

/// `bitclear`
fn entry_10(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.get::<u8>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitclear_byte(&mut v0, v1)?;
    args.put(n0, &v0)?;
    let () = done;
    Ok(())
}

/// `bitclear`
fn entry_11(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.get::<i32>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitclear_int(&mut v0, v1)?;
    args.put(n0, &v0)?;
    let () = done;
    Ok(())
}

/// `bitlcs`
fn entry_12(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitlcs_byte(v0, v1)?;
    args.result(&done)
}

/// `bitlcs`
fn entry_13(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitlcs_int(v0, v1)?;
    args.result(&done)
}

/// `bitrcs`
fn entry_14(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitrcs_byte(v0, v1)?;
    args.result(&done)
}

/// `bitrcs`
fn entry_15(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitrcs_int(v0, v1)?;
    args.result(&done)
}

/// `bitset`
fn entry_16(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.get::<u8>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitset_byte(&mut v0, v1)?;
    args.put(n0, &v0)?;
    let () = done;
    Ok(())
}

/// `bitset`
fn entry_17(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.get::<i32>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = bits::bitset_int(&mut v0, v1)?;
    args.put(n0, &v0)?;
    let () = done;
    Ok(())
}

/// `cdate`
fn entry_18(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let done = time::cdate(cx);
    args.result(&done)
}

/// `ceil`
fn entry_19(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::ceil(v0);
    args.result(&done)
}

/// `channeljoint`
fn entry_20(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let done = channel::channeljoint(cx, v0, v1)?;
    args.result(&done)
}

/// `channeljointvel`
fn entry_21(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let done = channel::channeljointvel(cx, v0, v1)?;
    args.result(&done)
}

/// `channelpose`
fn entry_22(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<Tool>(args.at(1)?)?;
    let v2 = args.get::<Wobj>(args.at(2)?)?;
    let v3 = args.get::<bool>(args.at(3)?)?;
    let done = channel::channelpose(cx, v0, v1, &v2, v3)?;
    args.result(&done)
}

/// `channeltcpvel`
fn entry_23(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<Tool>(args.at(1)?)?;
    let v2 = args.get::<Wobj>(args.at(2)?)?;
    let v3 = args.get::<bool>(args.at(3)?)?;
    let done = channel::channeltcpvel(cx, v0, v1, &v2, v3)?;
    args.result(&done)
}

/// `channeltojoint`
fn entry_24(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = channel::channeltojoint(cx, v0)?;
    args.result(&done)
}

/// `channeltopose`
fn entry_25(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<Tool>(args.at(1)?)?;
    let v2 = args.get::<Wobj>(args.at(2)?)?;
    let done = channel::channeltopose(cx, v0, v1, &v2)?;
    args.result(&done)
}

/// `cjoint`
fn entry_26(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let done = pose::cjoint(cx);
    args.result(&done)
}

/// `cjtci`
fn entry_27(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let done = channel::cjtci(cx, v0, v1)?;
    args.result(&done)
}

/// `cjttq`
fn entry_28(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let done = channel::cjttq(cx, v0, v1)?;
    args.result(&done)
}

/// `clearbuff`
async fn entry_29(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = socket::clearbuff(cx, h0.socket()?).await?;
    args.result(&done)
}

/// `clearbuff`
async fn entry_30(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = serial::clearbuff(cx, h0.iodev()?).await?;
    args.result(&done)
}

/// `clearbuff`
async fn entry_31(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = modbus_rtu::clearbuff(cx, h0.modbus_dev()?).await?;
    args.result(&done)
}

/// `clkread`
fn entry_32(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = clock::clkread(cx, h0.clock()?);
    args.result(&done)
}

/// `clkreset`
fn entry_33(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = clock::clkreset(cx, h0.clock()?);
    let () = done;
    Ok(())
}

/// `clkstart`
fn entry_34(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = clock::clkstart(cx, h0.clock()?);
    let () = done;
    Ok(())
}

/// `clkstop`
fn entry_35(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = clock::clkstop(cx, h0.clock()?);
    let () = done;
    Ok(())
}

/// `close`
async fn entry_36(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = socket::close(cx, h0.socket()?).await;
    let () = done;
    Ok(())
}

/// `close`
async fn entry_37(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = serial::close(cx, h0.iodev()?).await;
    let () = done;
    Ok(())
}

/// `close`
async fn entry_38(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = melsec::close(cx, h0.melsec_dev()?).await;
    let () = done;
    Ok(())
}

/// `close`
async fn entry_39(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = modbus_rtu::close(cx, h0.modbus_dev()?).await;
    let () = done;
    Ok(())
}

/// `connect`
async fn entry_40(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = socket::connect(cx, h0.socket()?, &*v1, v2).await?;
    args.result(&done)
}

/// `cos`
fn entry_41(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::cos(v0);
    args.result(&done)
}

/// `cosh`
fn entry_42(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::cosh(v0);
    args.result(&done)
}

/// `cpose`
fn entry_43(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let done = pose::cpose_default(cx)?;
    args.result(&done)
}

/// `cpose`
fn entry_44(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Tool>(args.at(0)?)?;
    let v1 = args.get::<Wobj>(args.at(1)?)?;
    let done = pose::cpose(cx, v0, &v1)?;
    args.result(&done)
}

/// `ctcpforce`
fn entry_45(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<Tool>(args.at(1)?)?;
    let v2 = args.get::<Wobj>(args.at(2)?)?;
    let done = channel::ctcpforce(cx, v0, v1, &v2)?;
    args.result(&done)
}

/// `ctime`
fn entry_46(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let done = time::ctime(cx);
    args.result(&done)
}

/// `curmpfile`
fn entry_47(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = channel::curmpfile(cx, v0)?;
    args.result(&done)
}

/// `curmpline`
fn entry_48(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = channel::curmpline(cx, v0)?;
    args.result(&done)
}

/// `curppfile`
fn entry_49(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = channel::curppfile(cx, v0)?;
    args.result(&done)
}

/// `curppline`
fn entry_50(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = channel::curppline(cx, v0)?;
    args.result(&done)
}

/// `dnread`
async fn entry_51(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let n2 = args.at(2)?;
    let mut v2 = args.array::<u8>(n2)?;
    let done = devicenet::dnread(cx, v0, v1, &mut v2).await?;
    args.put_array(n2, &v2)?;
    args.result(&done)
}

/// `dnwrite`
async fn entry_52(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.array::<u8>(args.at(2)?)?;
    let done = devicenet::dnwrite(cx, v0, v1, &v2).await?;
    args.result(&done)
}

/// `exp`
fn entry_53(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::exp(v0);
    args.result(&done)
}

/// `filesize`
async fn entry_54(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let done = files::filesize(cx, &*v0).await?;
    args.result(&done)
}

/// `floor`
fn entry_55(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::floor(v0);
    args.result(&done)
}

/// `fmod`
fn entry_56(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let done = math::fmod(v0, v1)?;
    args.result(&done)
}

/// `frexp`
fn entry_57(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<i32>(n1)?;
    let done = math::frexp_int(v0, &mut v1);
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `frexp`
fn entry_58(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<f64>(n1)?;
    let done = math::frexp_double(v0, &mut v1);
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `ftobytes`
fn entry_59(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = convert::ftobytes(v0, &mut v1, v2)?;
    args.put_array(n1, &v1)?;
    let () = done;
    Ok(())
}

/// `getai`
async fn entry_60(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getai(cx, v0).await?;
    args.result(&done)
}

/// `getao`
async fn entry_61(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getao(cx, v0).await?;
    args.result(&done)
}

/// `getbase_3p`
fn entry_62(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Joint>(args.at(2)?)?;
    let v3 = args.get::<Tool>(args.at(3)?)?;
    let v4 = args.get::<i32>(args.at(4)?)?;
    let done = calibration::getbase_3p(cx, v0, v1, v2, v3, v4)?;
    let () = done;
    Ok(())
}

/// `getdi`
async fn entry_63(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getdi(cx, v0).await?;
    args.result(&done)
}

/// `getdi`
async fn entry_64(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = io::getdi_group(cx, v0, v1).await?;
    args.result(&done)
}

/// `getdo`
async fn entry_65(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getdo(cx, v0).await?;
    args.result(&done)
}

/// `getdo`
async fn entry_66(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = io::getdo_group(cx, v0, v1).await?;
    args.result(&done)
}

/// `geterror`
async fn entry_67(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let done = socket::geterror(cx, h0.socket()?).await?;
    args.result(&done)
}

/// `getintdi`
async fn entry_68(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getintdi(cx, v0).await?;
    args.result(&done)
}

/// `getintdo`
async fn entry_69(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getintdo(cx, v0).await?;
    args.result(&done)
}

/// `getip`
async fn entry_70(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.get::<Str>(n0)?;
    let v1 = args.text(args.at(1)?)?;
    let done = socket::getip(cx, &mut v0, &*v1).await?;
    args.put(n0, &v0)?;
    args.result(&done)
}

/// `getjoint`
fn entry_71(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let v1 = args.get::<Tool>(args.at(1)?)?;
    let v2 = args.get::<Wobj>(args.at(2)?)?;
    let done = pose::getjoint(cx, v0, v1, &v2)?;
    args.result(&done)
}

/// `getnostopdi`
fn entry_72(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let done = io::getnostopdi(cx, v0)?;
    args.result(&done)
}

/// `getpose`
fn entry_73(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Tool>(args.at(1)?)?;
    let v2 = args.get::<Wobj>(args.at(2)?)?;
    let done = pose::getpose(cx, v0, v1, &v2)?;
    args.result(&done)
}

/// `gettextstr`
async fn entry_74(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<bool>(args.at(2)?)?;
    let done = files::gettextstr(cx, &*v0, v1, v2).await?;
    args.result(&done)
}

/// `gettool_3p`
fn entry_75(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Joint>(args.at(2)?)?;
    let v3 = args.get::<Wobj>(args.at(3)?)?;
    let done = calibration::gettool_3p(cx, v0, v1, v2, &v3)?;
    args.result(&done)
}

/// `gettoolrot_3p`
fn entry_76(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Joint>(args.at(2)?)?;
    let n3 = args.at(3)?;
    let mut v3 = args.get::<Tool>(n3)?;
    let done = calibration::gettoolrot_3p(cx, v0, v1, v2, &mut v3)?;
    args.put(n3, &v3)?;
    let () = done;
    Ok(())
}

/// `gettoolrot_world`
fn entry_77(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Tool>(n1)?;
    let done = calibration::gettoolrot_world(cx, v0, &mut v1)?;
    args.put(n1, &v1)?;
    let () = done;
    Ok(())
}

/// `gettooltcp_ref`
fn entry_78(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Tool>(args.at(2)?)?;
    let n3 = args.at(3)?;
    let mut v3 = args.get::<Tool>(n3)?;
    let done = calibration::gettooltcp_ref(cx, v0, v1, v2, &mut v3)?;
    args.put(n3, &v3)?;
    let () = done;
    Ok(())
}

/// `getwobj_3p`
fn entry_79(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Joint>(args.at(2)?)?;
    let v3 = args.get::<Tool>(args.at(3)?)?;
    let done = calibration::getwobj_3p(cx, v0, v1, v2, v3)?;
    args.result(&done)
}

/// `getwobj_flange`
fn entry_80(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Tool>(args.at(2)?)?;
    let v3 = args.get::<bool>(args.at(3)?)?;
    let done = calibration::getwobj_flange(cx, v0, v1, v2, v3)?;
    args.result(&done)
}

/// `getwobj_indi`
fn entry_81(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let v1 = args.get::<Joint>(args.at(1)?)?;
    let v2 = args.get::<Joint>(args.at(2)?)?;
    let v3 = args.get::<Pos>(args.at(3)?)?;
    let v4 = args.get::<Pos>(args.at(4)?)?;
    let v5 = args.get::<Pos>(args.at(5)?)?;
    let v6 = args.get::<Tool>(args.at(6)?)?;
    let done = calibration::getwobj_indi(cx, v0, v1, v2, v3, v4, v5, v6)?;
    args.result(&done)
}

/// `hypot`
fn entry_82(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let done = math::hypot(v0, v1);
    args.result(&done)
}

/// `init`
fn entry_83(cx: &Cx, _args: &mut Args<'_>) -> Result<(), Fault> {
    let done = system::init(cx);
    let () = done;
    Ok(())
}

/// `ldexp`
fn entry_84(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = math::ldexp(v0, v1);
    args.result(&done)
}

/// `log`
fn entry_85(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::log(v0)?;
    args.result(&done)
}

/// `log10`
fn entry_86(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::log10(v0)?;
    args.result(&done)
}

/// `modf`
fn entry_87(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<i32>(n1)?;
    let done = math::modf_int(v0, &mut v1)?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `modf`
fn entry_88(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<f64>(n1)?;
    let done = math::modf_double(v0, &mut v1);
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `norm`
fn entry_89(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pos>(args.at(0)?)?;
    let done = math::norm(v0);
    args.result(&done)
}

/// `offset`
fn entry_90(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let v2 = args.get::<f64>(args.at(2)?)?;
    let v3 = args.get::<f64>(args.at(3)?)?;
    let v4 = args.get::<f64>(args.at(4)?)?;
    let v5 = args.get::<f64>(args.at(5)?)?;
    let v6 = args.get::<f64>(args.at(6)?)?;
    let done = pose::offset(v0, v1, v2, v3, v4, v5, v6);
    args.result(&done)
}

/// `open`
async fn entry_91(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let v4 = args.get::<Stopbits>(args.at(4)?)?;
    let v5 = args.get::<Parity>(args.at(5)?)?;
    let done = serial::open(cx, h0.iodev()?, &*v1, v2, v3, v4, v5).await?;
    args.result(&done)
}

/// `open`
async fn entry_92(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = melsec::open(cx, h0.melsec_dev()?, &*v1, v2, v3).await?;
    args.result(&done)
}

/// `open`
async fn entry_93(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let v4 = args.get::<Parity>(args.at(4)?)?;
    let v5 = args.get::<i32>(args.at(5)?)?;
    let v6 = args.get::<Stopbits>(args.at(6)?)?;
    let done = modbus_rtu::open(cx, h0.modbus_dev()?, &*v1, v2, v3, v4, v5, v6).await?;
    args.result(&done)
}

/// `open`
async fn entry_94(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let v4 = args.get::<Stopbits>(args.at(4)?)?;
    let v5 = args.get::<i32>(args.at(5)?)?;
    let v6 = args.get::<Parity>(args.at(6)?)?;
    let done = modbus_rtu::open_stopbits_first(cx, h0.modbus_dev()?, &*v1, v2, v3, v4, v5, v6).await?;
    args.result(&done)
}

/// `P`
fn entry_95(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = event::elapsed_percent(cx, v0);
    args.result(&done)
}

/// `poseinv`
fn entry_96(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let done = pose::poseinv(v0);
    args.result(&done)
}

/// `pow`
fn entry_97(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let done = math::pow(v0, v1);
    args.result(&done)
}

/// `pow10`
fn entry_98(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::pow10(v0);
    args.result(&done)
}

/// `pulsedo`
async fn entry_99(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let v2 = args.get::<f64>(args.at(2)?)?;
    let done = io::pulsedo(cx, v0, v1, v2).await?;
    let () = done;
    Ok(())
}

/// `rand`
fn entry_100(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let done = math::rand(cx);
    args.result(&done)
}

/// `read`
async fn entry_101(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Str>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = socket::read_string(cx, h0.socket()?, &mut v1, v2).await?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_102(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = socket::read_bytes(cx, h0.socket()?, &mut v1, v2).await?;
    args.put_array(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_103(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Str>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = serial::read_string(cx, h0.iodev()?, &mut v1, v2).await?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_104(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = serial::read_bytes(cx, h0.iodev()?, &mut v1, v2).await?;
    args.put_array(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_105(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Str>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = melsec::read_string(cx, h0.melsec_dev()?, &mut v1, v2, v3).await?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_106(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = melsec::read_bytes(cx, h0.melsec_dev()?, &mut v1, v2, v3).await?;
    args.put_array(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_107(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Str>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = modbus_rtu::read_string(cx, h0.modbus_dev()?, &mut v1, v2, v3).await?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `read`
async fn entry_108(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = modbus_rtu::read_bytes(cx, h0.modbus_dev()?, &mut v1, v2, v3).await?;
    args.put_array(n1, &v1)?;
    args.result(&done)
}

/// `readcoils`
async fn entry_109(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.array::<u8>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = modbus_tcp::readcoils(cx, &mut v0, v1, v2).await?;
    args.put_array(n0, &v0)?;
    args.result(&done)
}

/// `readregisters`
async fn entry_110(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.get::<Str>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = modbus_tcp::readregisters_string(cx, &mut v0, v1, v2).await?;
    args.put(n0, &v0)?;
    args.result(&done)
}

/// `readregisters`
async fn entry_111(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let n0 = args.at(0)?;
    let mut v0 = args.array::<u8>(n0)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = modbus_tcp::readregisters_bytes(cx, &mut v0, v1, v2).await?;
    args.put_array(n0, &v0)?;
    args.result(&done)
}

/// `readuntil`
async fn entry_112(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Str>(n1)?;
    let v2 = args.text(args.at(2)?)?;
    let done = socket::readuntil(cx, h0.socket()?, &mut v1, &*v2).await?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `readuntil`
async fn entry_113(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.get::<Str>(n1)?;
    let v2 = args.text(args.at(2)?)?;
    let done = serial::readuntil(cx, h0.iodev()?, &mut v1, &*v2).await?;
    args.put(n1, &v1)?;
    args.result(&done)
}

/// `reltool`
fn entry_114(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let v2 = args.get::<f64>(args.at(2)?)?;
    let v3 = args.get::<f64>(args.at(3)?)?;
    let v4 = args.get::<f64>(args.at(4)?)?;
    let v5 = args.get::<f64>(args.at(5)?)?;
    let v6 = args.get::<f64>(args.at(6)?)?;
    let done = pose::reltool(v0, v1, v2, v3, v4, v5, v6);
    args.result(&done)
}

/// `removefile`
async fn entry_115(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let done = files::removefile(cx, &*v0).await?;
    args.result(&done)
}

/// `renamefile`
async fn entry_116(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let done = files::renamefile(cx, &*v0, &*v1).await?;
    args.result(&done)
}

/// `S`
fn entry_117(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = event::elapsed_distance(cx, v0);
    args.result(&done)
}

/// `savearl`
async fn entry_118(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<bool>(args.at(2)?)?;
    let done = points::savearl(cx, &*v0, &*v1, v2).await?;
    args.result(&done)
}

/// `savefilejoint`
async fn entry_119(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<Joint>(args.at(2)?)?;
    let done = points::savefilejoint(cx, &*v0, &*v1, v2).await?;
    args.result(&done)
}

/// `savefilepose`
async fn entry_120(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<Pose>(args.at(2)?)?;
    let done = points::savefilepose(cx, &*v0, &*v1, v2).await?;
    args.result(&done)
}

/// `savejointnow`
async fn entry_121(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<u32>(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.text(args.at(2)?)?;
    let v3 = args.get::<Joint>(args.at(3)?)?;
    let done = points::savejointnow(cx, v0, &*v1, &*v2, v3).await?;
    args.result(&done)
}

/// `saveposenow`
async fn entry_122(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<u32>(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.text(args.at(2)?)?;
    let v3 = args.get::<Pose>(args.at(3)?)?;
    let done = points::saveposenow(cx, v0, &*v1, &*v2, v3).await?;
    args.result(&done)
}

/// `savesv`
async fn entry_123(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let done = system::savesv(cx, &*v0).await?;
    let () = done;
    Ok(())
}

/// `setao`
async fn entry_124(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let done = io::setao(cx, v0, v1).await?;
    let () = done;
    Ok(())
}

/// `setcycle`
async fn entry_125(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = modbus_rtu::setcycle(cx, h0.modbus_dev()?, v1).await?;
    let () = done;
    Ok(())
}

/// `setdo`
async fn entry_126(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let done = io::setdo(cx, v0, v1).await?;
    let () = done;
    Ok(())
}

/// `setdo`
async fn entry_127(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = io::setdo_group(cx, v0, v1, v2).await?;
    let () = done;
    Ok(())
}

/// `setip`
async fn entry_128(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.text(args.at(2)?)?;
    let v3 = args.text(args.at(3)?)?;
    let done = socket::setip(cx, &*v0, &*v1, &*v2, &*v3).await?;
    args.result(&done)
}

/// `setpwm`
async fn entry_129(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = io::setpwm(cx, v0, v1, v2).await?;
    args.result(&done)
}

/// `sin`
fn entry_130(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::sin(v0);
    args.result(&done)
}

/// `sinh`
fn entry_131(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::sinh(v0);
    args.result(&done)
}

/// `sqrt`
fn entry_132(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::sqrt(v0)?;
    args.result(&done)
}

/// `StoEnd`
fn entry_133(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = event::left_distance(cx, v0);
    args.result(&done)
}

/// `strlen`
fn entry_134(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let done = strings::strlen(&*v0);
    args.result(&done)
}

/// `substr`
fn entry_135(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = match args.find(2) {
        Some(n2) => Some(args.get::<i32>(n2)?),
        None => None,
    };
    let done = strings::substr(&*v0, v1, v2)?;
    args.result(&done)
}

/// `switcharl`
async fn entry_136(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<u32>(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let done = channel::switcharl(cx, v0, &*v1).await?;
    args.result(&done)
}

/// `syncao`
async fn entry_137(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<f64>(args.at(1)?)?;
    let done = io::syncao(cx, v0, v1).await?;
    let () = done;
    Ok(())
}

/// `syncdo`
async fn entry_138(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let done = io::syncdo(cx, v0, v1).await?;
    let () = done;
    Ok(())
}

/// `syncdo`
async fn entry_139(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = io::syncdo_group(cx, v0, v1, v2).await?;
    let () = done;
    Ok(())
}

/// `T`
fn entry_140(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = event::elapsed_time(cx, v0);
    args.result(&done)
}

/// `tan`
fn entry_141(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::tan(v0);
    args.result(&done)
}

/// `tanh`
fn entry_142(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = math::tanh(v0);
    args.result(&done)
}

/// `toascii`
fn entry_143(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let done = strings::toascii(&*v0)?;
    args.result(&done)
}

/// `tobytes`
fn entry_144(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = convert::tobytes_string(&*v0, &mut v1, v2)?;
    args.put_array(n1, &v1)?;
    let () = done;
    Ok(())
}

/// `tobytes`
fn entry_145(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = convert::tobytes_int(v0, &mut v1, v2)?;
    args.put_array(n1, &v1)?;
    let () = done;
    Ok(())
}

/// `tobytes`
fn entry_146(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let n1 = args.at(1)?;
    let mut v1 = args.array::<u8>(n1)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = convert::tobytes_double(v0, &mut v1, v2)?;
    args.put_array(n1, &v1)?;
    let () = done;
    Ok(())
}

/// `todouble`
fn entry_147(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.array::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = convert::todouble(&v0, v1)?;
    args.result(&done)
}

/// `tofloat`
fn entry_148(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.array::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = convert::tofloat(&v0, v1)?;
    args.result(&done)
}

/// `toint`
fn entry_149(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let done = convert::toint_double(v0)?;
    args.result(&done)
}

/// `toint`
fn entry_150(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.array::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = convert::toint_bytes(&v0, v1)?;
    args.result(&done)
}

/// `toint`
fn entry_151(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.get::<NumBase>(args.at(1)?)?;
    let done = convert::toint_string(&*v0, v1)?;
    args.result(&done)
}

/// `tostr`
fn entry_152(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.printed(args.at(0)?);
    let done = convert::tostr(&v0);
    args.result(&done)
}

/// `tostr`
fn entry_153(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<NumBase>(args.at(1)?)?;
    let done = convert::tostr_base(v0, v1);
    args.result(&done)
}

/// `tostr`
fn entry_154(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let done = convert::tostr_precision(v0, v1)?;
    args.result(&done)
}

/// `trunc`
fn entry_155(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<bool>(args.at(2)?)?;
    let done = math::trunc(v0, v1, v2)?;
    args.result(&done)
}

/// `typeof`
fn entry_156(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.printed(args.at(0)?);
    let done = convert::type_name(&v0);
    args.result(&done)
}

/// `write`
async fn entry_157(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let done = socket::write_string(cx, h0.socket()?, &*v1).await?;
    args.result(&done)
}

/// `write`
async fn entry_158(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.array::<u8>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = socket::write_bytes(cx, h0.socket()?, &v1, v2).await?;
    args.result(&done)
}

/// `write`
async fn entry_159(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let done = serial::write_string(cx, h0.iodev()?, &*v1).await?;
    args.result(&done)
}

/// `write`
async fn entry_160(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.array::<u8>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = serial::write_bytes(cx, h0.iodev()?, &v1, v2).await?;
    args.result(&done)
}

/// `write`
async fn entry_161(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = match args.find(3) {
        Some(n3) => Some(args.get::<i32>(n3)?),
        None => None,
    };
    let done = melsec::write_string(cx, h0.melsec_dev()?, &*v1, v2, v3).await?;
    args.result(&done)
}

/// `write`
async fn entry_162(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.array::<u8>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = melsec::write_bytes(cx, h0.melsec_dev()?, &v1, v2, v3).await?;
    args.result(&done)
}

/// `write`
async fn entry_163(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.text(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = modbus_rtu::write_string(cx, h0.modbus_dev()?, &*v1, v2).await?;
    args.result(&done)
}

/// `write`
async fn entry_164(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let h0 = args.handle(args.at(0)?)?;
    let v1 = args.array::<u8>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let v3 = args.get::<i32>(args.at(3)?)?;
    let done = modbus_rtu::write_bytes(cx, h0.modbus_dev()?, &v1, v2, v3).await?;
    args.result(&done)
}

/// `writecoils`
async fn entry_165(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.array::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = modbus_tcp::writecoils(cx, &v0, v1, v2).await?;
    args.result(&done)
}

/// `writeregisters`
async fn entry_166(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = match args.find(2) {
        Some(n2) => Some(args.get::<i32>(n2)?),
        None => None,
    };
    let done = modbus_tcp::writeregisters_string(cx, &*v0, v1, v2).await?;
    args.result(&done)
}

/// `writeregisters`
async fn entry_167(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.array::<u8>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let v2 = args.get::<i32>(args.at(2)?)?;
    let done = modbus_tcp::writeregisters_bytes(cx, &v0, v1, v2).await?;
    args.result(&done)
}

/// `accset`
fn entry_168(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let call = motion::accset(v0, v1);
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `ccir`
async fn entry_169(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let call = motion::ccir(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vl(args.get::<f64>(n)?),
            3 => call = call.vp(args.get::<f64>(n)?),
            4 => call = call.s(args.get::<Slip>(n)?),
            5 => call = call.sl(args.get::<f64>(n)?),
            6 => call = call.sp(args.get::<f64>(n)?),
            7 => call = call.t(args.get::<Tool>(n)?),
            8 => call = call.w(&args.get::<Wobj>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `cir`
async fn entry_170(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let v1 = args.get::<Pose>(args.at(1)?)?;
    let call = motion::cir(v0, v1);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            2 => call = call.v(args.get::<Speed>(n)?),
            3 => call = call.vl(args.get::<f64>(n)?),
            4 => call = call.vp(args.get::<f64>(n)?),
            5 => call = call.s(args.get::<Slip>(n)?),
            6 => call = call.sl(args.get::<f64>(n)?),
            7 => call = call.sp(args.get::<f64>(n)?),
            8 => call = call.t(args.get::<Tool>(n)?),
            9 => call = call.w(&args.get::<Wobj>(n)?),
            10 => call = call.ca(args.get::<f64>(n)?),
            11 => call = call.dura(args.get::<f64>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `compen`
fn entry_171(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    match args.base(args.at(6)?)? {
        Base::Enum(Enum::CompenType) => {
            let v6 = args.get::<CompenType>(args.at(6)?)?;
            let call = motion::compen(v6);
            let mut call = call;
            for n in 0..args.count() {
                match args.param(n) {
                    0 => call = call.x(args.get::<f64>(n)?),
                    1 => call = call.y(args.get::<f64>(n)?),
                    2 => call = call.z(args.get::<f64>(n)?),
                    3 => call = call.a(args.get::<f64>(n)?),
                    4 => call = call.b(args.get::<f64>(n)?),
                    5 => call = call.c(args.get::<f64>(n)?),
                    _ => {}
                }
            }
            let done = call.run(cx)?;
            let () = done;
            Ok(())
        }
        Base::String => {
            let v6 = args.text(args.at(6)?)?;
            let call = motion::compen(&*v6);
            let mut call = call;
            for n in 0..args.count() {
                match args.param(n) {
                    0 => call = call.x(args.get::<f64>(n)?),
                    1 => call = call.y(args.get::<f64>(n)?),
                    2 => call = call.z(args.get::<f64>(n)?),
                    3 => call = call.a(args.get::<f64>(n)?),
                    4 => call = call.b(args.get::<f64>(n)?),
                    5 => call = call.c(args.get::<f64>(n)?),
                    _ => {}
                }
            }
            let done = call.run(cx)?;
            let () = done;
            Ok(())
        }
        _ => Err(damaged()),
    }
}

/// `delint`
fn entry_172(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = event::delint();
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => call = call.name(&*args.text(n)?),
            1 => call = call.priority(args.get::<i32>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `disableint`
fn entry_173(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = event::disableint();
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => call = call.name(&*args.text(n)?),
            1 => call = call.priority(args.get::<i32>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `enableint`
fn entry_174(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = event::enableint();
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => call = call.name(&*args.text(n)?),
            1 => call = call.priority(args.get::<i32>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `endcompen`
fn entry_175(cx: &Cx, _args: &mut Args<'_>) -> Result<(), Fault> {
    let call = motion::endcompen();
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `enddetect`
fn entry_176(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = motion::enddetect();
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => call = call.mu(&*args.text(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `endweave`
fn entry_177(cx: &Cx, _args: &mut Args<'_>) -> Result<(), Fault> {
    let call = motion::endweave();
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `jump`
async fn entry_180(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let call = motion::jump(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vp(args.get::<f64>(n)?),
            3 => call = call.t(args.get::<Tool>(n)?),
            4 => call = call.w(&args.get::<Wobj>(n)?),
            5 => call = call.a(args.get::<f64>(n)?),
            6 => call = call.b(args.get::<f64>(n)?),
            7 => call = call.z(args.get::<f64>(n)?),
            8 => call = call.ctr(args.get::<Control>(n)?),
            9 => call = call.s(args.get::<bool>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `lin`
async fn entry_181(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let call = motion::lin(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vl(args.get::<f64>(n)?),
            3 => call = call.vp(args.get::<f64>(n)?),
            4 => call = call.s(args.get::<Slip>(n)?),
            5 => call = call.sl(args.get::<f64>(n)?),
            6 => call = call.sp(args.get::<f64>(n)?),
            7 => call = call.t(args.get::<Tool>(n)?),
            8 => call = call.w(&args.get::<Wobj>(n)?),
            9 => call = call.dura(args.get::<f64>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `movej`
async fn entry_182(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Joint>(args.at(0)?)?;
    let call = motion::movej(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vp(args.get::<f64>(n)?),
            3 => call = call.s(args.get::<Slip>(n)?),
            4 => call = call.sp(args.get::<f64>(n)?),
            5 => call = call.sl(args.get::<f64>(n)?),
            6 => call = call.t(args.get::<Tool>(n)?),
            7 => call = call.dura(args.get::<f64>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `pause`
async fn entry_183(cx: &Cx, _args: &mut Args<'_>) -> Result<(), Fault> {
    let call = flow::pause();
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `print`
fn entry_184(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = text::print();
    let n1 = args.find(1);
    let mut v1 = match n1 {
        Some(n) => args.get::<Str>(n)?,
        None => Default::default(),
    };
    let mut r1 = Some(&mut v1);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => call = call.to(args.get::<Printto>(n)?),
            1 => {
                if let Some(v) = r1.take() {
                    call = call.tostr(v)
                }
            }
            2 => call = call.filepath(&*args.text(n)?),
            3 => call = call.precision(args.get::<i32>(n)?),
            4 => call = call.numbase(args.get::<NumBase>(n)?),
            5 => call = call.argtoprint(&args.printed(n)),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    if let Some(n) = n1 {
        args.put(n, &v1)?;
    }
    let () = done;
    Ok(())
}

/// `ptp`
async fn entry_185(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let call = motion::ptp(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vp(args.get::<f64>(n)?),
            3 => call = call.s(args.get::<Slip>(n)?),
            4 => call = call.sl(args.get::<f64>(n)?),
            5 => call = call.sp(args.get::<f64>(n)?),
            6 => call = call.t(args.get::<Tool>(n)?),
            7 => call = call.w(&args.get::<Wobj>(n)?),
            8 => call = call.dura(args.get::<f64>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `scan`
fn entry_187(_cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.text(args.at(0)?)?.into_owned();
    let v1 = args.text(args.at(1)?)?.into_owned();
    let call = text::scan(&v0, &v1);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            2 => match args.base(n)? {
                Base::Int => {
                    let mut v = args.get::<i32>(n)?;
                    call = call.argtosave(&mut v);
                    args.put(n, &v)?;
                }
                Base::Double => {
                    let mut v = args.get::<f64>(n)?;
                    call = call.argtosave(&mut v);
                    args.put(n, &v)?;
                }
                Base::Bool => {
                    let mut v = args.get::<bool>(n)?;
                    call = call.argtosave(&mut v);
                    args.put(n, &v)?;
                }
                Base::String => {
                    let mut v = args.get::<Str>(n)?;
                    call = call.argtosave(&mut v);
                    args.put(n, &v)?;
                }
                _ => return Err(damaged()),
            },
            _ => {}
        }
    }
    let done = call.run()?;
    let () = done;
    Ok(())
}

/// `setdoimv`
fn entry_188(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<bool>(args.at(1)?)?;
    let call = io::setdoimv(v0, v1);
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `spl`
async fn entry_189(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Pose>(args.at(0)?)?;
    let call = motion::spl(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.v(args.get::<Speed>(n)?),
            2 => call = call.vl(args.get::<f64>(n)?),
            3 => call = call.vp(args.get::<f64>(n)?),
            4 => call = call.s(args.get::<Slip>(n)?),
            5 => call = call.sl(args.get::<f64>(n)?),
            6 => call = call.sp(args.get::<f64>(n)?),
            7 => call = call.t(args.get::<Tool>(n)?),
            8 => call = call.w(&args.get::<Wobj>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}

/// `startcompen`
fn entry_190(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Compendata>(args.at(0)?)?;
    let call = motion::startcompen(v0);
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `startdetect`
fn entry_191(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let call = motion::startdetect(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.mu(&*args.text(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `startmove`
fn entry_192(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = event::startmove();
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => {
                call = match args.base(n)? {
                    Base::Int => call.skip(args.get::<i32>(n)?),
                    Base::Bool => call.skip(args.get::<bool>(n)?),
                    _ => return Err(damaged()),
                }
            }
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `startweave`
fn entry_193(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<Weavedata>(args.at(0)?)?;
    let call = motion::startweave(v0);
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `stopmove`
fn entry_194(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let call = event::stopmove();
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            0 => call = call.stop(args.get::<Stoptype>(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `toolload`
fn entry_196(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<ToolInertiaPara>(args.at(0)?)?;
    let call = motion::toolload(v0);
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `toolswitch`
fn entry_197(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let call = motion::toolswitch(v0);
    let mut call = call;
    for n in 0..args.count() {
        match args.param(n) {
            1 => call = call.mu(&*args.text(n)?),
            _ => {}
        }
    }
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `velset`
fn entry_199(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<i32>(args.at(0)?)?;
    let v1 = args.get::<i32>(args.at(1)?)?;
    let call = motion::velset(v0, v1);
    let done = call.run(cx)?;
    let () = done;
    Ok(())
}

/// `waittime`
async fn entry_200(cx: &Cx, args: &mut Args<'_>) -> Result<(), Fault> {
    let v0 = args.get::<f64>(args.at(0)?)?;
    let call = flow::waittime(v0);
    let done = call.run(cx).await?;
    let () = done;
    Ok(())
}
