//! `arl2rs emit` and `arl2rs build`

use arl_project::cache::{Cache, Kind, write_if_changed};
use arl_project::listing;
use arl_project::options::Checking;
use arl_project::program::{Job, bug, check_options, compile_rust};
use arl_project::runtime::Runtime;
use arl_robot::result_file::expect_apart;
use arl_terminal::answer;
use arl_terminal::failure::Failure;
use arl2rs::compile::compile_program;
use arl2rs::emit::EmitOptions;
use arl2rs::sources::FileSystem;
use std::path::{Path, PathBuf};

/// Writes the Rust of a program to standard output, or to NAME.rs in a folder.
pub(crate) fn emit(file: &Path, out: Option<&Path>, checking: &Checking) -> Result<(), Failure> {
    let checking = checking.of_program(file)?;
    let mut compiled =
        compile_program(file, &FileSystem, &check_options(&checking)?, &EmitOptions::default()).map_err(bug)?;
    listing::show(&compiled, &mut listing::Limit::default());
    let rust = compiled.rust.take().ok_or(Failure::Shown)?;
    let Some(folder) = out else {
        return answer::write(&rust);
    };
    let name = compiled.checked.program.as_ref().map_or("program", |program| program.name.as_str());
    write_if_changed(&folder.join(format!("{name}.rs")), rust.as_bytes())?;
    Ok(())
}

/// Makes a native program, or a library, with the programs that the cell names.
pub(crate) fn build(
    file: &Path,
    out: Option<&Path>,
    release: bool,
    library: bool,
    checking: &Checking,
) -> Result<(), Failure> {
    let checking = checking.of_program(file)?;
    let job = Job::new(file, checking.cell.as_deref(), &checking)?;
    let job = if library { job.into_kind(Kind::Library) } else { job };
    let done = job.compile(&FileSystem)?;
    let cache = Cache::find()?;
    let place = job.place(&cache)?;
    let to = out.map_or_else(|| default_name(file, library), Path::to_path_buf);
    let files = done.files();
    let inputs: Vec<_> = files.iter().map(|path| ("a file of the program", path.as_path())).collect();
    expect_apart(&[("the program to be built", &to)], &inputs).map_err(Failure::Usage)?;
    if let Some(folder) = to.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|error| Failure::io("make the folder", folder, &error))?;
    }
    let _lock = place.lock(false)?;
    compile_rust(&cache, &place, Runtime::find(), &done.rust, &job.main()?, release, &to)
}

fn default_name(file: &Path, library: bool) -> PathBuf {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
    let stem = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_else(|| "program".into());
    PathBuf::from(if library { format!("{DLL_PREFIX}{stem}{DLL_SUFFIX}") } else { format!("{stem}{EXE_SUFFIX}") })
}
