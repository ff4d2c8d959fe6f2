//! Every form of the language becomes the tree that it should.

mod support {
    pub(crate) mod show;
}

use arl_lang::ast::{ExprKind, Item, StmtKind};
use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, parse, parse_expression};
use support::show::{items, statements};

/// Each line becomes the tree behind it.
fn check(cases: &[(&str, &str)]) {
    for (source, wanted) in cases {
        assert_eq!(statements(source), *wanted, "{source}");
    }
}

#[test]
fn expressions() {
    check(&[
        ("x = 1 + 2 * 3", "(x = (1 + (2 * 3)))"),
        ("x = (1 + 2) * 3", "(x = ((1 + 2) * 3))"),
        ("x = a - b - c", "(x = ((a - b) - c))"),
        (
            "x = a || b && c | d ^ e & f == g < h << i + j * k",
            "(x = (a || (b && (c | (d ^ (e & (f == (g < (h << (i + (j * k)))))))))))",
        ),
        (
            "x = a * b + c << d < e == f & g ^ h | i && j || k",
            "(x = ((((((((((a * b) + c) << d) < e) == f) & g) ^ h) | i) && j) || k))",
        ),
        ("x = a / b % c", "(x = ((a / b) % c))"),
        ("x = a >> 1 >= b != c <= d", "(x = (((a >> 1) >= b) != (c <= d)))"),
        ("x = -a.b[1] + !c - ~d", "(x = (((-a.b[1]) + (!c)) - (~d)))"),
        ("x = - -a", "(x = (-(-a)))"),
        ("a = b = c", "(a = (b = c))"),
        ("a += b", "(a += b)"),
        ("a -= b *= c", "(a -= (b *= c))"),
        ("a /= 1", "(a /= 1)"),
        ("a %= 1", "(a %= 1)"),
        ("a <<= 1", "(a <<= 1)"),
        ("a >>= 1", "(a >>= 1)"),
        ("a &= 1", "(a &= 1)"),
        ("a |= 1", "(a |= 1)"),
        ("a ^= 1", "(a ^= 1)"),
        ("i++", "(i++)"),
        ("--p.x", "(--p.x)"),
        ("x = i++ + ++j", "(x = ((i++) + (++j)))"),
        ("f()", "f()"),
        ("f(1, g(2), -3)", "f(1, g(2), (-3))"),
        ("b[2][3] = 5", "(b[2][3] = 5)"),
        ("x = ffh + 3eh + 0bh + 10b + C0h", "(x = ((((ffh + 3eh) + bh) + 10b) + c0h))"),
        ("x = 9.000e+09 + .5 + 5.", "(x = ((9000000000.0 + 0.5) + 5.0))"),
        ("s = \"a\\n\\\"b\\\\\"", r#"(s = "a\n\"b\\")"#),
        ("x = true && false", "(x = (true && false))"),
        ("x = 5 % 3", "(x = (5 % 3))"),
        ("x = 5%3", "(x = (5 % 3))"),
        ("x = a%b", "(x = (a % b))"),
        ("x = endl", "(x = endl)"),
    ]);
}

#[test]
fn names_and_paths() {
    check(&[
        ("x = a::add(1,2) + a :: gc", "(x = (a::add(1, 2) + a::gc))"),
        ("x = $VEL_PROFILE :: S_TYPE", "(x = $vel_profile::s_type)"),
        ("x = controlmode::AUTO", "(x = controlmode::auto)"),
        ("$VEL_PROFILE = S_type", "($vel_profile = s_type)"),
        ("$TOOLS[0].t_frame = w . w_frame", "($tools[0].t_frame = w.w_frame)"),
        ("w.weaveshape = tool2.speed", "(w.weaveshape = tool2.speed)"),
        ("X = AbC", "(x = abc)"),
    ]);
}

#[test]
fn braces() {
    check(&[
        ("p = {1, 2,3}", "(p = {1, 2, 3})"),
        ("p = {x 1, y -5.7, z a}", "(p = {x 1, y (-5.7), z a})"),
        ("p = {x -y}", "(p = {x (-y)})"),
        ("p = {(x)-y}", "(p = {(x - y)})"),
        ("p = {x, y}", "(p = {x, y})"),
        ("p = {x+1, y*2, f(1)}", "(p = {(x + 1), (y * 2), f(1)})"),
        ("p = {x !a, y ~b, z $C, a \"s\", b true}", "(p = {x (!a), y (~b), z $c, a \"s\", b true})"),
        ("t = {{x 0,y 10},{b 90},false}", "(t = {{x 0, y 10}, {b 90}, false})"),
        ("t = {t_frame {x 1}, stationary true}", "(t = {t_frame {x 1}, stationary true})"),
        ("p = {1, 2,}", "(p = {1, 2})"),
        ("p = { j4 0, }", "(p = {j4 0})"),
        ("p = {}", "(p = {})"),
        ("w = {weaveshape simple, frequency 2}", "(w = {weaveshape simple, frequency 2})"),
        ("w = {weaveshape::simple, 2}", "(w = {weaveshape::simple, 2})"),
        ("p = {f(a, b), c}", "(p = {f(a, b), c})"),
        ("p = {a[1], b.c}", "(p = {a[1], b.c})"),
    ]);
}

#[test]
fn declarations() {
    check(&[
        ("int a", "int a"),
        ("int x = 1, y = 3", "int x = 1, y = 3"),
        ("double a [10]", "double a[10]"),
        ("double b [2] [3] = {1,2,3,1,2,3}", "double b[2][3] = {1, 2, 3, 1, 2, 3}"),
        ("const double p = 3.14", "const double p = 3.14"),
        ("Centroid_Pos c = {1}", "centroid_pos c = {1}"),
        ("socket s", "socket s"),
        ("$VEL_PROFILE v = S_TYPE", "$vel_profile v = s_type"),
        ("int n = 2*3, m[n+1]", "int n = (2 * 3), m[(n + 1)]"),
        ("spl jump = 1", "@spl (jump = 1)"),
        ("control ctr1 = {rising_vel 0}", "control ctr1 = {rising_vel 0}"),
    ]);
}

#[test]
fn instructions() {
    check(&[
        (
            "lin p1,v:{tcp 20};T(1), setdo(2,true);S(100),setdo(3,true)",
            "@lin p1, v:{tcp 20} ; t(1) -> setdo(2, true) ; s(100) -> setdo(3, true)",
        ),
        ("interrupt 1,when:getdi(5),do:inthandler1()", "@interrupt 1, when:getdi(5), do:inthandler1()"),
        ("stopmove fast", "@stopmove fast"),
        ("startmove true", "@startmove true"),
        ("scan from:\"1.1 \",delimiter:\",\",x,y", "@scan from:\"1.1 \", delimiter:\",\", x, y"),
        ("print \"255 =\",hex,255,\"h\"", "@print \"255 =\", hex, 255, \"h\""),
        ("print $VEL_PROFILE::S_TYPE", "@print $vel_profile::s_type"),
        ("print", "@print"),
        ("print (1+2)*3, \"x\"", "@print ((1 + 2) * 3), \"x\""),
        ("print A|B, -1, a - 1", "@print (a | b), (-1), (a - 1)"),
        ("print to:file,filepath:\"mylog\",i,endl", "@print to:file, filepath:\"mylog\", i, endl"),
        ("lin p:p1,vp:5%,sp:-1%", "@lin p:p1, vp:5<%>, sp:(-1)<%>"),
        ("lin P : p1 , vl:100mm/s,sl:5 mm,dura:2s", "@lin p:p1, vl:100<mm/s>, sl:5<mm>, dura:2<s>"),
        ("x a:1deg,b:1.5 deg / s", "@x a:1<deg>, b:1.5<deg/s>"),
        ("waituntil getdi(6),maxtime:5", "@waituntil getdi(6), maxtime:5"),
        ("waittime(5)", "@waittime 5"),
        ("movej j:{j1 20,ej1 30}", "@movej j:{j1 20, ej1 30}"),
        ("pause", "@pause"),
        ("lin p:p1,t:$tool0,w:$WORLD", "@lin p:p1, t:$tool0, w:$world"),
        ("toolload $TOOL_INERTIA[3]", "@toolload $tool_inertia[3]"),
        ("compen x:100,type:TOOL", "@compen x:100, type:tool"),
        ("compen type:WOBJ,x:1", "@compen type:wobj, x:1"),
        ("startweave w1={simple,10}", "@startweave (w1 = {simple, 10})"),
        ("velset 50,800", "@velset 50, 800"),
        ("timer name:\"t1\",rmode:true,do:setdo(1,true)", "@timer name:\"t1\", rmode:true, do:setdo(1, true)"),
    ]);
}

#[test]
fn instructions_whose_names_are_not_reserved() {
    check(&[
        ("spl P:P3", "@spl p:p3"),
        ("spl p3", "@spl p3"),
        ("jump p1,vp:5%", "@jump p1, vp:5<%>"),
        ("disableint", "@disableint"),
        ("delint \"x\"", "@delint \"x\""),
        ("startdetect cid:1 ,mu:R1", "@startdetect cid:1, mu:r1"),
        ("setdoimv channel:3,value:true", "@setdoimv channel:3, value:true"),
        ("jump = 5", "(jump = 5)"),
        ("jump++", "(jump++)"),
        ("jump(5)", "jump(5)"),
        ("spl.x = 1", "(spl.x = 1)"),
        ("int spl = 3", "int spl = 3"),
        ("linn p:p1", "@linn p:p1"),
        ("linn p1,v:v1", "@linn p1, v:v1"),
        ("prnt \"x\"", "@prnt \"x\""),
        ("mytype p1", "mytype p1"),
        ("mytype p1, p2", "mytype p1, p2"),
    ]);
}

#[test]
fn blocks() {
    check(&[
        ("if(a)\nb()\nelseif(c)\nd()\nelse\ne()\nendif", "if a\n  b()\nelseif c\n  d()\nelse\n  e()"),
        ("if(a)\nendif", "if a"),
        ("if(getdi(3)) setdo(3,true)", "when getdi(3)\n  setdo(3, true)"),
        ("if(a-- == 0) break", "when ((a--) == 0)\n  break"),
        ("if((a) && (b)) lin p1,v:5", "when (a && b)\n  @lin p1, v:5"),
        ("if(a) spl p3", "when a\n  @spl p3"),
        ("if(a) (b).c = 1", "when a\n  (b.c = 1)"),
        ("if(a) \\\n  goto x", "when a\n  goto x"),
        ("while(counter--)\nx()\nendwhile", "while (counter--)\n  x()"),
        ("repeat\nx()\nuntil(a >= 3)", "repeat (a >= 3)\n  x()"),
        ("loop\nbreak\ncontinue\nendloop", "loop\n  break\n  continue"),
        ("for(int i = 0;i<5;i++)\nx()\nendfor", "for int i = 0; (i < 5); (i++)\n  x()"),
        ("for(i=0;;)\nendfor", "for (i = 0); ;"),
        ("for(;;)\nendfor", "for ; ;"),
        ("next:\ngoto next", "next:\ngoto next"),
        ("Return", "return"),
        ("return a+1", "return (a + 1)"),
        ("Endwhile2 = 1", "(endwhile2 = 1)"),
    ]);
}

#[test]
fn switch() {
    check(&[
        (
            "switch(j)\ncase 0:\na()\ncase 1: b()\ncase c::d:\ncase \"x\" :\ndefault:\nd()\nendswitch",
            "switch j\n  case 0\n    a()\n  case 1\n    b()\n  case c::d\n  case \"x\"\n  case default\n    d()",
        ),
        ("switch(j)\nendswitch", "switch j"),
        (
            "switch(j)\ncase f(a:1): if(x) break\ndefault: y()\nendswitch",
            "switch j\n  case f(a:1)\n    when x\n      break\n  case default\n    y()",
        ),
    ]);
}

#[test]
fn files() {
    assert_eq!(
        items(
            "import \"/x/a.arl\"\nint a = 1\nfunc void inthandler1\nendfunc\nFunc int Sum(int a[10], pose p)\nreturn a[0]\nEndFunc\nconst pos p[2] = {{1},{2}}\n"
        ),
        "import \"/x/a.arl\"\nint a = 1\nfunc void inthandler1()\nfunc int sum(int a[10], pose p)\n  return a[0]\nconst pos p[2] = {{1}, {2}}"
    );
    assert_eq!(items(""), "");
    assert_eq!(items("\u{feff}func void main()\r\nx()\r\nendfunc"), "func void main()\n  x()");
    assert_eq!(items("func void main()\rx()\rendfunc\r"), "func void main()\n  x()");
}

#[test]
fn comments_and_continued_lines() {
    check(&[
        ("x = 1 // y = 2 \\\ny = 3", "(x = 1)\n(y = 3)"),
        ("/* a\nb */ x = 1 /* c */ + 2", "(x = (1 + 2))"),
        ("x = 1 /* a\n b */ + 2", "(x = (1 + 2))"),
        ("x = 1 \\\n  + 2 \\  \r\n + 3", "(x = ((1 + 2) + 3))"),
        ("s = \"//no comment\"", "(s = \"//no comment\")"),
        ("x = 1 \\", "(x = 1)"),
        ("/**/x = 1", "(x = 1)"),
    ]);
}

#[test]
fn splices() {
    check(&[
        ("x = #a + #(b.c(\")\") + ')')", "(x = (#0 + #1))"),
        ("lin p:#target,vl:#(speed(1))", "@lin p:#0, vl:#1"),
        ("p = {x #a, y #b}", "(p = {x #0, y #1})"),
        ("x = 0x3e", "(x = 3eh)"),
    ]);
    let source = "f(#a, #(b + c))";
    let parsed = parse_expression(source, &mut Interner::new(), ParseOptions { splices: true });
    let spliced: Vec<(&str, bool)> =
        parsed.splices.iter().map(|splice| (splice.span.text(source), splice.parenthesised)).collect();
    assert_eq!(spliced, [("a", false), ("b + c", true)]);
}

#[test]
fn spans_cover_what_they_stand_for() {
    let source = "func void main()\n  x = (a + b) * f(1)\n  if(c)\n  endif\nendfunc\n";
    let parsed = parse(source, &mut Interner::new(), ParseOptions::default());
    let Item::Func(func) = &parsed.file.items[0] else { panic!() };
    assert_eq!(func.span.text(source), "func void main()");
    assert_eq!(func.end.text(source), "endfunc");
    assert_eq!(func.name.span.text(source), "main");
    assert_eq!(func.body[0].span.text(source), "x = (a + b) * f(1)");
    assert_eq!(func.body[1].span.text(source), "if(c)");
    let StmtKind::Expr(assign) = &func.body[0].kind else { panic!() };
    let ExprKind::Assign(_, parts) = &assign.kind else { panic!() };
    let ExprKind::Binary(_, factors) = &parts.1.kind else { panic!() };
    assert_eq!(factors.0.span.text(source), "(a + b)");
    assert_eq!(factors.1.span.text(source), "f(1)");
}

#[test]
fn one_expression() {
    let mut interner = Interner::new();
    let good = parse_expression(" a + 1 ", &mut interner, ParseOptions::default());
    assert!(good.errors.is_empty() && matches!(good.expr.kind, ExprKind::Binary(..)));
    for bad in ["", "a\nb", "lin p1", "if(a) b()"] {
        let parsed = parse_expression(bad, &mut interner, ParseOptions::default());
        assert_eq!(parsed.errors.iter().map(|error| error.kind.number()).collect::<Vec<_>>(), [153], "{bad}");
    }
}
