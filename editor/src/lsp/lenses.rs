//! What can be done with a program, above its `main`. The commands are the editor's: it knows where to show the output.

use super::server::{Refusal, Server};
use super::uri::path_of;
use arl_project::expectations::EXPECTATIONS;
use gen_lsp_types::*;
use std::path::Path;

pub(super) fn lenses(server: &Server, params: CodeLensParams) -> Result<Option<Vec<CodeLens>>, Refusal> {
    let path = path_of(&params.text_document.uri);
    let find = || {
        let file = server.file(&path)?;
        let text = file.text(server)?;
        let is_main = |name: &str| name.eq_ignore_ascii_case("main");
        let mut functions = file.index().functions.iter().filter(|function| function.at.file == file.id);
        let main = functions.find(|function| is_main(&function.name))?;
        let range = text.range(main.at.span);
        let lens = |(title, command): (&str, &str)| CodeLens {
            range,
            command: Some(Command {
                title: title.into(),
                tooltip: None,
                command: command.into(),
                arguments: Some(vec![serde_json::Value::String(params.text_document.uri.0.clone())]),
            }),
            data: None,
        };
        let mut all = vec![("run", "arl2rs.run"), ("plot", "arl2rs.plot")];
        if is_case(&path) {
            all.push(("test", "arl2rs.test"));
        }
        Some(all.into_iter().map(lens).collect())
    };
    Ok(find())
}

fn is_case(path: &Path) -> bool {
    EXPECTATIONS.iter().any(|ending| path.with_extension(ending.trim_start_matches('.')).is_file())
}
