//! `strandsnap render`.

use super::animation::AnimationArgs;
use super::ended::Ended;
use super::look::LookArgs;
use super::select::SelectArgs;
use crate::base::error::Result;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as out/ka4; one that was stopped will do
    run: PathBuf,
    /// Folder of the pictures [default: RUN/render]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace earlier pictures in that folder
    #[arg(long)]
    overwrite: bool,
    /// Go on with pictures that an earlier process was ended over: those that are whole and show the same are not drawn
    /// again. Where there are none, begin
    #[arg(long, conflicts_with = "view")]
    resume: bool,
    /// Go on where files of the run were changed or are another's; the result says so
    #[arg(long)]
    anyway: bool,
    /// Draw one view, as `strandsnap explore` writes it, to view.png in that folder; several of them and --animation
    /// make the film of a camera that goes from each to the next
    ///
    /// Its keys, separated by commas, are: state (number of the snapshot, from 0), azimuth, elevation (degrees), centre, height
    /// (mm), perspective (angle that the height is seen under), follow (z of a section before loading, mm), colour, range,
    /// hidden_layers, hidden_wires, ghost_layers, selected (numbers from 0), explode, cut (mm), theme, supersampling. For example
    /// 'state = 40, azimuth = 30, height = 8'
    #[arg(long, value_name = "KEYS", conflicts_with_all = ["strain_range", "events", "every", "animation_width", "views",
        "colour", "theme", "supersampling", "azimuth", "elevation", "zoom", "focus_z"])]
    view: Vec<String>,
    /// Draw the pictures that the run's scene asks for (`output.picture`) into its folder `pictures`, in place of earlier ones
    #[arg(long, conflicts_with_all = ["view", "out", "resume", "strain_range", "events", "every"])]
    pictures: bool,
    /// Time that the camera of a film takes from each view to the next
    #[arg(long, value_name = "TIME", value_parser = super::values::duration, default_value = "2s", requires = "view")]
    leg: std::time::Duration,
    /// A second run beside the first one in such a view or film
    #[arg(long, value_name = "RUN", requires = "view")]
    with: Option<PathBuf>,
    #[command(flatten)]
    select: SelectArgs,
    #[command(flatten)]
    animation: AnimationArgs,
    /// Show no progress, and one line at the end
    #[arg(long)]
    quiet: bool,
    #[command(flatten)]
    look: LookArgs,
}

#[cfg(not(feature = "render"))]
pub fn render(_args: Args) -> Result<Ended> {
    let instead = "draw on a machine where it is";
    Err(crate::run::outputs::built_without("frames", "render", instead))
}

#[cfg(feature = "render")]
pub fn render(args: Args) -> Result<Ended> {
    use super::counted::Counted;
    use super::say::say;
    use crate::base::digest::Digest;
    use crate::base::error::Error;
    use crate::base::wording::counted;
    use crate::render::FrameWriter;
    use crate::run::build::build;
    use crate::run::replay::Replay;
    use crate::run::{folder, identity, outputs};

    if args.pictures {
        return pictures(&args);
    }
    if !args.view.is_empty() {
        return views(args);
    }
    let doubts = identity::check(&args.run, args.anyway)?;
    let run = Replay::open(&args.run, &args.select.into())?.doubting(&doubts);
    let mut output = look_of(&args.run);
    args.look.apply(&mut output);
    let out = args.out.unwrap_or_else(|| args.run.join("render"));
    let animation = args.animation.resolve(&out.join(folder::ANIMATION));
    let begun = args.resume && folder::drawn_before(&out).is_some();
    if args.resume && !begun && !args.overwrite && folder::holds_something(&out) {
        return Err(Error::input(
            format!("{} holds no unfinished pictures", out.display()),
            "there is nothing to go on with; --overwrite draws all again, in place of those that are there",
        ));
    }
    let folder = folder::OutFolder::check(&out, args.overwrite || begun)?;
    if let Some(animation) = &animation {
        animation.check(args.overwrite)?;
    }
    crate::render::check()?;
    // Another build may draw otherwise.
    let drawn = Digest::of(format!("{} {output:?} {}", run.digest(), build()));
    let is_whole: &dyn Fn(&std::path::Path) -> bool = &crate::render::png::is_whole;
    let pictures = folder.open_for_pictures(&drawn, args.resume.then_some(is_whole), None)?;
    if begun {
        match pictures.whole().len() {
            0 if pictures.replaced_others() => {
                eprintln!("note: the pictures there are of another run, view or build; all are drawn again");
            }
            whole => eprintln!("note: {whole} of {} were drawn before", counted(run.count(), "picture")),
        }
    }
    let whole = pictures.whole().clone();
    // The run is over: close-ups can look at its main fracture from the start, and need not go there.
    let writer = FrameWriter::new(&out, &output)?.knowing(run.ruptures().to_vec());
    let mut writer = writer.with_origin(run.origin()).with_animation(animation.clone()).without(whole);
    if let Some(why) = run.cut_off() {
        eprintln!("note: {why}; what there is will be drawn");
    }
    let stop = super::interrupt::install()?;
    let shown = run.show(&mut Counted::new(&mut writer, run.count(), !args.quiet), stop)?;
    let timings = writer.timings();
    let drawn = shown - timings.not_drawn as usize;
    say!("{} in {}", counted(drawn, "picture"), out.display());
    if drawn == run.count() && !timings.unfinished() {
        pictures.complete()?;
    } else {
        say!("stopped: {} of {} pictures are left; --resume goes on", run.count() - drawn, run.count());
    }
    if let Some(animation) = animation.filter(|_| timings.animation_bytes > 0) {
        say!("{} of animation are in {}", outputs::megabytes(timings.animation_bytes), animation.file.display());
    }
    if !args.quiet {
        say!("frames: {timings}");
    }
    super::interrupt::ended(stop)
}

#[cfg(all(feature = "render", not(feature = "explore")))]
fn pictures(_args: &Args) -> Result<Ended> {
    Err(crate::run::outputs::built_without("pictures of a view", "explore", "draw frames without --pictures"))
}

/// Draws the pictures of a run's own scene.
#[cfg(feature = "explore")]
fn pictures(args: &Args) -> Result<Ended> {
    use super::say::say;
    use crate::base::error::Error;
    use crate::run::folder;

    let file = args.run.join(folder::SCENE);
    let spec = crate::scene::load(&file.to_string_lossy(), &[])?.spec;
    if spec.output.pictures.is_empty() {
        return Err(Error::input(
            format!("{} asks for no pictures", file.display()),
            "a run draws those that its scene asks for with [[output.picture]]; --view draws any other",
        ));
    }
    crate::explore::pictures::check(&args.run, &spec.output)?;
    let stop = super::interrupt::install()?;
    let drawn = crate::explore::pictures::draw(&args.run, &spec, stop)?;
    drawn.made.iter().for_each(|picture| say!("{}", picture.display()));
    drawn.left_out.iter().for_each(|why| eprintln!("WARNING: {why}"));
    if drawn.stopped {
        say!("Still to be made: {}", crate::explore::pictures::command(&args.run));
    }
    super::interrupt::ended(stop)
}

#[cfg(all(feature = "render", not(feature = "explore")))]
fn views(_args: Args) -> Result<Ended> {
    Err(crate::run::outputs::built_without("single views", "explore", "draw frames without --view"))
}

#[cfg(feature = "explore")]
fn views(args: Args) -> Result<Ended> {
    use super::say::say;
    use crate::base::error::Error;
    use crate::explore::{View, picture};

    let out = args.out.clone().unwrap_or_else(|| args.run.join("render"));
    let mut output = crate::scene::spec::OutputSpec::default();
    args.look.apply(&mut output);
    let views: Vec<View> = args.view.iter().map(|words| View::parse(words)).collect::<Result<_>>()?;
    if let Some(animation) = args.animation.resolve(&out.join("film.mp4")) {
        let path = crate::explore::CameraPath { views, seconds: args.leg.as_secs_f64() };
        return film(
            &args.run,
            args.with.as_deref(),
            path,
            output.frame_size,
            &animation,
            [args.overwrite, args.quiet],
        );
    }
    let [view] = &views[..] else {
        return Err(Error::input(
            format!("--view is there {} times", views.len()),
            "give one for a picture; several are what the camera of a film comes by, which --animation asks for",
        ));
    };
    let file = out.join("view.png");
    if file.exists() && !args.overwrite {
        let instead = "give --overwrite to replace it, or another folder with --out";
        return Err(Error::input(format!("{} exists", file.display()), instead));
    }
    let bytes = picture(&args.run, args.with.as_deref(), view, output.frame_size)?;
    crate::base::regular::make_folder(&out)?;
    crate::render::png::write(&file, &bytes)?;
    say!("the view is in {}", file.display());
    Ok(Ended::Well)
}

/// The film of a camera path.
#[cfg(feature = "explore")]
fn film(
    run: &std::path::Path,
    with: Option<&std::path::Path>,
    path: crate::explore::CameraPath,
    size: [u32; 2],
    animation: &crate::observe::animation::Animation,
    [overwrite, quiet]: [bool; 2],
) -> Result<Ended> {
    use super::say::say;
    use crate::base::error::Error;
    use crate::explore::FilmTarget;
    use crate::observe::animation::Format;

    if animation.format()? != Format::Film {
        return Err(Error::input(
            format!("a camera path cannot be written as {}", animation.file.display()),
            "give --animation a name that ends in .mp4",
        ));
    }
    animation.check(overwrite)?;
    if let Some(folder) = animation.file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        crate::base::regular::make_folder(folder)?;
    }
    let stop = super::interrupt::install_saying("\nstopping; nothing is left of the film")?;
    let bar = super::counted::bar(path.pictures(), !quiet);
    let target = FilmTarget { file: &animation.file, size, stop };
    let made = crate::explore::film(run, with, path, &target, &mut |done, _| bar.set_position(done as u64));
    bar.finish_and_clear();
    say!("{} of film are in {}", crate::run::outputs::megabytes(made?), animation.file.display());
    Ok(Ended::Well)
}

/// How the run's own scene wants its frames to look. A trajectory alone, or a scene that this program cannot read any
/// more, leaves the usual look.
#[cfg(feature = "render")]
fn look_of(run: &std::path::Path) -> crate::scene::spec::OutputSpec {
    let file = run.join(crate::run::folder::SCENE);
    if !file.is_file() {
        return Default::default();
    }
    match crate::scene::load(&file.to_string_lossy(), &[]) {
        Ok(scene) => scene.spec.output,
        Err(error) => {
            eprintln!("note: {} cannot be read ({error}); pictures get the usual look", file.display());
            Default::default()
        }
    }
}
