use super::format;

#[track_caller]
fn check(input: &str, expected: &str) {
    assert_eq!(format(input), expected);
    assert_eq!(format(expected), expected, "once more");
}

fn indented(line: &str) -> String {
    if line.is_empty() { "\n".into() } else { format!("    {line}\n") }
}

/// Checks statements of a function.
#[track_caller]
fn statements(input: &str, expected: &str) {
    let expected: String = expected.lines().map(indented).collect();
    check(&format!("func void main()\n{input}\nendfunc"), &format!("func void main()\n{expected}endfunc\n"));
}

#[test]
fn blocks_move_to_the_right() {
    check(
        "func void main()\nif(a)\nb=1\nelseif(c)\nb=2\nelse\nwhile(d)\nb=3\nendwhile\nendif\nfor(;;)\nloop\nrepeat\nb=4\n\
         until(e)\nendloop\nendfor\nagain:\ngoto again\nendfunc",
        "func void main()\n    if(a)\n        b = 1\n    elseif(c)\n        b = 2\n    else\n        while(d)\n            \
         b = 3\n        endwhile\n    endif\n    for(;;)\n        loop\n            repeat\n                b = 4\n            \
         until(e)\n        endloop\n    endfor\n    again:\n    goto again\nendfunc\n",
    );
    statements(
        "switch(a)\n  case 1:\nb=1\ndefault :\nb=2\nendswitch",
        "switch(a)\ncase 1:\n    b = 1\ndefault:\n    b = 2\nendswitch",
    );
    statements(
        "switch(a)\ncase 1:b=1\ncase -2 :if(c)\nb=1\nendif\nendswitch",
        "switch(a)\ncase 1: b = 1\ncase -2: if(c)\n        b = 1\n    endif\nendswitch",
    );
}

#[test]
fn an_if_on_one_line_opens_no_block() {
    statements("if( a )  b=1\nb=2", "if(a) b = 1\nb = 2");
    statements("if((a)+(b))++i\nif(a)-b\nif(a)(b).c=1", "if((a) + (b)) ++i\nif(a) -b\nif(a) (b).c = 1");
    statements("if(a)lin p\nif(a) \\\nb=1", "if(a) lin p\nif(a) \\\n    b = 1");
}

#[test]
fn blocks_that_do_not_fit_do_no_harm() {
    check("endif\nendfunc\nx=1", "endif\nendfunc\nx = 1\n");
    check(
        "func void a()\nif(b)\nx=1\nfunc void c()\nendfunc",
        "func void a()\n    if(b)\n        x = 1\n\nfunc void c()\nendfunc\n",
    );
    statements("if(a)\nendif\nendif\nx=1", "if(a)\nendif\nendif\nx = 1");
    statements("else\ncase 1:\nx=1", "else\ncase 1:\nx = 1");
    check(&"loop\n".repeat(300), &{
        let lines = (0..300_usize).map(|at| format!("{}loop\n", " ".repeat(4 * at.min(200))));
        lines.collect::<String>()
    });
}

#[test]
fn lines_with_mistakes_stay() {
    check("int a\n  int  = =2  \nint  b", "int a\n  int  = =2  \nint b\n");
    check("int a=1 // a\nint b=， // b\nint c=1 // c", "int a = 1 // a\nint b=， // b\nint c = 1 // c\n");
    check("int  a /* open\n int  b", "int  a /* open\n int  b\n");
}

#[test]
fn blanks_between_lexemes() {
    statements(
        "IF ( a&&!b||c==-1 )\nx [ 1 ]=y . z+ - - 1\nendif\nwhile (a)\nendwhile",
        "if(a && !b || c == -1)\n    x[1] = y.z + - -1\nendif\nwhile(a)\nendwhile",
    );
    statements("i ++\n-- j\na+=b - --c\nreturn(a)\nreturn -1", "i++\n--j\na += b - --c\nreturn (a)\nreturn -1");
    statements("x=a%b\nx=!!a\nx=~ ~a<<2", "x = a % b\nx = !!a\nx = ~~a << 2");
    statements("for(int i=0;i<3;i ++)\nendfor", "for(int i = 0; i < 3; i++)\nendfor");
    statements("f( )\ng ( a ,b [ 1 ] [ 2 ] )\nmod :: f(1)", "f()\ng(a, b[1][2])\nmod::f(1)");
    statements("int a[3]={1 ,2,3 , }\npose p={ x 1,y-2 , z (3) }", "int a[3] = {1, 2, 3,}\npose p = {x 1, y -2, z(3)}");
    statements("pose p = {x  1 , y - 2}\nq={{1,2},{3}}", "pose p = {x 1, y -2}\nq = {{1, 2}, {3}}");
    statements("print\"a\",b\nprint(a)\nprint -1", "print \"a\", b\nprint (a)\nprint -1");
}

#[test]
fn arguments() {
    statements(
        "lin p : p1,vl:100 mm / s,sp : 50 %;T(1),setdo( 1,true )\nmovej  j,vp:v%\nlin {x 1},vl:-a",
        "lin p:p1, vl:100mm/s, sp:50%; T(1), setdo(1, true)\nmovej j, vp:v%\nlin {x 1}, vl:-a",
    );
    statements("lin p,sp:a % b\nlin p,sp:5 %\nwaittime 2 s", "lin p, sp:a % b\nlin p, sp:5%\nwaittime 2s");
}

#[test]
fn words_of_the_language_are_spelled_as_in_the_manual() {
    check(
        "CONST Int a=TRUE\nSocket s\nFUNC Void main()\nMoveJ J:x,VP:5%\nSETDO(1,False)\nx=stopType::FAST\n$dfspeed.PER=1\n\
         $Vel_Profile v=$vel_profile::T_type\nlin p;stoend(1),Pulsedo(PORT:1)\nEndFunc",
        "const int a = true\nsocket s\nfunc void main()\n    movej j:x, vp:5%\n    setdo(1, false)\n    x = stoptype::fast\n    \
         $DFSPEED.PER = 1\n    $VEL_PROFILE v = $VEL_PROFILE::T_TYPE\n    lin p; StoEnd(1), pulsedo(PORT:1)\nendfunc\n"
            .replace("PORT:1", &format!("{}:1", label_of("pulsedo", "port").unwrap_or("PORT")))
            .as_str(),
    );
}

/// The label of a built-in function in the catalog's spelling.
fn label_of(function: &str, label: &str) -> Option<&'static str> {
    let params = arl_lang::catalog::functions(function).iter().flat_map(|entry| entry.params);
    params.map(|param| param.name).find(|name| name.eq_ignore_ascii_case(label))
}

#[test]
fn names_of_the_program_stay() {
    check(
        "func int Abs(int X)\n    return X\nendfunc\n\nfunc void Main()\n    int Jump = ABS(1)\n    Jump = Sin\n    \
         Other::SIN(1)\n    a.SIN = SIN(1)\n    MyEnum::FAST(1)\n    print PI, FAST\nSPL:\nendfunc",
        "func int Abs(int X)\n    return X\nendfunc\n\nfunc void Main()\n    int Jump = ABS(1)\n    Jump = Sin\n    \
         Other::SIN(1)\n    a.SIN = sin(1)\n    MyEnum::FAST(1)\n    print PI, FAST\n    SPL:\nendfunc\n",
    );
    // Spellings of other editions are kept, in their own case.
    statements(
        "StartWeaveLin w\nToolInertiapara t\nTOOLSWITCH 1,MU_name:m",
        "startweavelin w\nToolInertiaPara t\ntoolswitch 1, mu_name:m",
    );
}

#[test]
fn comments_at_line_ends_stand_in_a_column() {
    statements(
        "a=1//one  \nbcd=2   // two\n\ne=3// three\nif(f)// four\nh=4 // five\nendif",
        "a = 1   //one\nbcd = 2 // two\n\ne = 3 // three\nif(f) // four\n    h = 4 // five\nendif",
    );
    let long = format!("x = {}", "y".repeat(50));
    statements(
        &format!("a=1//1\nbc=2//2\n{long} //3\nd=4//4"),
        &format!("a = 1  //1\nbc = 2 //2\n{long} //3\nd = 4 //4"),
    );
}

#[test]
fn a_declaration_without_a_comment_parts_no_column() {
    check(
        "const int PICK=1 // where parts come\nconst int NOTHING=2\nconst int DEPOSIT=300 // where they go\n",
        "const int PICK = 1      // where parts come\nconst int NOTHING = 2\nconst int DEPOSIT = 300 // where they go\n",
    );
    // A blank line does, and so does a statement.
    statements(
        "int a=1//1\nint b\n\nint cde=2//2\nf=4\nint g=5//3",
        "int a = 1 //1\nint b\n\nint cde = 2 //2\nf = 4\nint g = 5 //3",
    );
}

#[test]
fn comments_on_lines_of_their_own() {
    check(
        "  // top\nint a\n// f\nfunc void f()\n// in\nif(a)\n// b\nb=1\n// end of if\nelse\n// empty\nendif\n// last\nendfunc\n // end",
        "// top\nint a\n// f\nfunc void f()\n    // in\n    if(a)\n        // b\n        b = 1\n        // end of if\n    else\n        \
         // empty\n    endif\n    // last\nendfunc\n// end\n",
    );
    statements(
        "switch(a)\n// first\ncase 1:\nb=1\n// second\ncase 2:\nendswitch",
        "switch(a)\n// first\ncase 1:\n    b = 1\n// second\ncase 2:\nendswitch",
    );
    check("func void f()\n  /* one\n  two */\nendfunc", "func void f()\n    /* one\n  two */\nendfunc\n");
    statements(
        "f(/*a*/ 1,/*b*/2/*c*/)/*d*/\n/*e*/a=/*f*/-/*g*/b",
        "f(/*a*/ 1, /*b*/ 2 /*c*/) /*d*/\n/*e*/ a = /*f*/ - /*g*/ b",
    );
}

#[test]
fn tables_of_points() {
    check(
        "pose a={x 1,y 200,z 3}//first\npose bcd={x -10,y 2,z 30} // second\n\npose e={x 1}\npose f={x 1,y 2}\nint g=1\nint hi=2",
        "pose a   = {x 1,   y 200, z 3} //first\npose bcd = {x -10, y 2,   z 30} // second\n\npose e = {x 1}\n\
         pose f = {x 1, y 2}\nint g = 1\nint hi = 2\n"
            .replace("z 3} //", "z 3}  //")
            .as_str(),
    );
    check(
        "const joint a[2]={{1,2},{3,4}}\nconst joint b[2]={{10,2},{3,4}}",
        "const joint a[2] = {{1, 2},  {3, 4}}\nconst joint b[2] = {{10, 2}, {3, 4}}\n",
    );
    let wide = format!("pose a = {{x {}, y 1}}\npose bc = {{x 1, y 2}}\n", "1".repeat(105));
    check(&wide, &wide);
}

#[test]
fn blank_lines() {
    check("\n\n\nint a\n\n\n\nint b\n\n\n", "int a\n\nint b\n");
    check("", "");
    check(" \n\t\n", "");
    statements(
        "\na=1\n\n\nif(b)\n\na=2\n\nelse\n\n// c\n\nendif\n",
        "a = 1\n\nif(b)\n    a = 2\nelse\n    // c\nendif",
    );
    check(
        "int a\nfunc void a()\nendfunc\n// of b\n// more\nfunc void b()\nendfunc\n// apart\n\nfunc void c()\nendfunc\n\n\nfunc void d()\nendfunc",
        "int a\nfunc void a()\nendfunc\n\n// of b\n// more\nfunc void b()\nendfunc\n\n// apart\n\nfunc void c()\nendfunc\n\nfunc void d()\nendfunc\n",
    );
}

#[test]
fn continued_lines() {
    statements("a=1+\\\n2+ \\ \n  3\nb=1", "a = 1 + \\\n    2 + \\\n    3\nb = 1");
    check("int a=1\\\n\nint b", "int a = 1 \\\n\nint b\n");
    check("int a=1\\\n\n", "int a = 1 \\\n");
    check("int a=1\\", "int a = 1 \\\n");
    check("\\\nint a=1 // b", "\\\n    int a = 1 // b\n");
}

#[test]
fn line_ends_and_the_mark_stay() {
    check("int a\r\n\r\n\r\nint b\n", "int a\r\n\r\nint b\r\n");
    check("int a\nint  b\r\n", "int a\nint b\n");
    check("int a\rint  b", "int a\rint b\r");
    check("\u{feff}int  a", "\u{feff}int a\n");
    check("/* a\r\n b */int  a", "/* a\r\n b */ int a\r\n");
}

#[test]
fn structure_goes_on_behind_mistakes() {
    let text = "func void f()\n    if(a {\n        x = 1\n    } else {\n        x = 2\n    }\n    while a\n        x = 3\n    end\nendfunc\n";
    check(text, text);
    let text = "func void f()\n    if(a > 1\n        x = 1\n    endif\n    x = 2\nendfunc\n";
    check(text, text);
    let text = "func void f()\n    if(a > 1 print \"b\"\n    x = 2\nendfunc\n";
    check(text, text);
    check("int  a\n/* open\n\n", "int a\n/* open\n");
}
