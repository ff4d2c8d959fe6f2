//! The pages of the diagnostics, embedded. `UPDATE_PAGES=1 cargo test -p arl2rs pages` renews the list.

macro_rules! pages {
    ($($code:literal)*) => {
        &[$(($code, include_str!(concat!("../../../docs/diagnostics/", $code, ".md")))),*]
    };
}

/// Code and text of every page, ascending.
pub(super) static PAGES: &[(&str, &str)] = pages! {
    "ARL0101"
    "ARL0102"
    "ARL0103"
    "ARL0104"
    "ARL0105"
    "ARL0106"
    "ARL0107"
    "ARL0108"
    "ARL0109"
    "ARL0110"
    "ARL0111"
    "ARL0112"
    "ARL0113"
    "ARL0114"
    "ARL0115"
    "ARL0116"
    "ARL0117"
    "ARL0118"
    "ARL0120"
    "ARL0121"
    "ARL0122"
    "ARL0123"
    "ARL0124"
    "ARL0125"
    "ARL0126"
    "ARL0127"
    "ARL0128"
    "ARL0129"
    "ARL0130"
    "ARL0131"
    "ARL0132"
    "ARL0133"
    "ARL0134"
    "ARL0135"
    "ARL0136"
    "ARL0137"
    "ARL0138"
    "ARL0139"
    "ARL0140"
    "ARL0141"
    "ARL0142"
    "ARL0143"
    "ARL0144"
    "ARL0145"
    "ARL0146"
    "ARL0147"
    "ARL0148"
    "ARL0149"
    "ARL0150"
    "ARL0151"
    "ARL0152"
    "ARL0153"
    "ARL0201"
    "ARL0202"
    "ARL0203"
    "ARL0204"
    "ARL0205"
    "ARL0206"
    "ARL0207"
    "ARL0208"
    "ARL0209"
    "ARL0210"
    "ARL0211"
    "ARL0212"
    "ARL0213"
    "ARL0214"
    "ARL0301"
    "ARL0302"
    "ARL0303"
    "ARL0304"
    "ARL0305"
    "ARL0306"
    "ARL0307"
    "ARL0308"
    "ARL0309"
    "ARL0310"
    "ARL0311"
    "ARL0312"
    "ARL0313"
    "ARL0314"
    "ARL0315"
    "ARL0316"
    "ARL0317"
    "ARL0318"
    "ARL0319"
    "ARL0320"
    "ARL0321"
    "ARL0322"
    "ARL0323"
    "ARL0324"
    "ARL0325"
    "ARL0326"
    "ARL0327"
    "ARL0328"
    "ARL0401"
    "ARL0402"
    "ARL0403"
    "ARL0404"
    "ARL0405"
    "ARL0406"
    "ARL0407"
    "ARL0408"
    "ARL0409"
    "ARL0410"
    "ARL0411"
    "ARL0412"
    "ARL0413"
    "ARL0414"
    "ARL0415"
    "ARL0501"
    "ARL0502"
    "ARL0503"
    "ARL0504"
    "ARL0505"
    "ARL0506"
    "ARL0507"
    "ARL0508"
    "ARL0509"
    "ARL0511"
    "ARL0512"
    "ARL0513"
    "ARL0601"
    "ARL0602"
    "ARL0603"
    "ARL0604"
    "ARL0605"
    "ARL0606"
    "ARL0702"
    "ARL0703"
    "ARL0704"
    "ARL0801"
    "ARL0802"
    "ARL0803"
    "ARL0804"
    "ARL0805"
    "ARL0806"
    "ARL0807"
    "ARL0808"
    "ARL0809"
    "ARL0851"
    "ARL0852"
    "ARL0853"
    "ARL0901"
    "ARL0902"
    "ARL0903"
    "ARL0904"
    "ARL0905"
    "ARL0906"
    "ARL0907"
    "ARL0908"
    "ARL0909"
    "ARL0910"
    "ARL0911"
    "ARL0912"
    "ARL0951"
    "ARL0952"
    "ARL0953"
};

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_page_is_in_the_list() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let folder = here.join("../docs/diagnostics");
        let mut there: Vec<String> = std::fs::read_dir(folder)
            .map(|entries| entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect())
            .unwrap_or_default();
        there.retain(|name| name.starts_with("ARL") && name.ends_with(".md"));
        there.sort();
        let listed: Vec<String> = PAGES.iter().map(|(code, _)| format!("{code}.md")).collect();
        if listed != there && std::env::var_os("UPDATE_PAGES").is_some() {
            let path = here.join("src/cli/pages.rs");
            let source = std::fs::read_to_string(&path).expect("this file");
            let start = source.find("= pages! {\n").expect("the list") + "= pages! {\n".len();
            let end = start + source[start..].find("};").expect("its end");
            let lines: String =
                there.iter().map(|name| format!("    \"{}\"\n", name.trim_end_matches(".md"))).collect();
            std::fs::write(&path, format!("{}{lines}{}", &source[..start], &source[end..])).expect("written");
            return;
        }
        assert_eq!(listed, there, "renew the list: UPDATE_PAGES=1 cargo test -p arl2rs pages");
    }
}
