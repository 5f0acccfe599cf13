//! MERGE: stand-ins for what other branches bring. Delete this file, its line in `lib.rs`, and run
//! `sed -i 's/crate::pending::/crate::/' $(grep -rl crate::pending src)`.
#![allow(missing_docs, unused)]

pub mod scene {
    use crate::base::error::{Error, Result};
    use crate::scene::spec::Spec;
    pub struct SceneSource;
    impl SceneSource {
        pub fn error(&self, key: &str, what: impl Into<String>, help: impl Into<String>) -> Error {
            Error::input(format!("{key}: {}", what.into()), help)
        }
    }
    pub struct Scene {
        pub spec: Spec,
        pub source: SceneSource,
    }
    pub fn load(name_or_path: &str, overrides: &[String]) -> Result<Scene> {
        Err(Error::input(
            format!("cannot load {name_or_path} {overrides:?}"),
            "merge the scene floor",
        ))
    }
    pub mod builtin {
        pub fn list() -> &'static [(&'static str, &'static str)] {
            &[]
        }
    }
    pub mod write {
        pub fn to_toml(spec: &crate::scene::spec::Spec) -> String {
            format!("{spec:?}")
        }
    }
    pub mod plan {
        pub struct Plan;
        impl Plan {
            pub fn new(_spec: &crate::scene::spec::Spec) -> Self {
                Self
            }
        }
        impl std::fmt::Display for Plan {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                writeln!(f, "no plan yet")
            }
        }
    }
}

pub mod strand {
    use crate::scene::spec::Spec;
    use crate::strand::assembly::Assembly;
    pub struct BuildError {
        pub key: String,
        pub what: String,
        pub help: String,
    }
    pub fn build(_spec: &Spec) -> Result<Assembly, BuildError> {
        Err(BuildError {
            key: "strand".into(),
            what: "cannot build".into(),
            help: "merge the strand floor".into(),
        })
    }
    pub mod centrelines {
        pub fn export(_assembly: &crate::strand::assembly::Assembly) -> String {
            String::new()
        }
    }
}

pub mod observe {
    macro_rules! idle {
        ($name:ty) => {
            impl crate::observe::Observer for $name {
                fn start(
                    &mut self,
                    _: &std::sync::Arc<crate::engine::view::RunInfo>,
                ) -> crate::base::error::Result<()> {
                    Ok(())
                }
                fn finish(&mut self) -> crate::base::error::Result<()> {
                    Ok(())
                }
            }
        };
    }
    pub mod trajectory {
        use crate::base::error::Result;
        use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot};
        use std::path::Path;
        use std::sync::Arc;
        pub struct TrajectoryWriter;
        impl TrajectoryWriter {
            pub fn new(_file: &Path) -> Self {
                Self
            }
        }
        idle!(TrajectoryWriter);
        pub enum Event {
            Sample(Sample),
            Snapshot(Snapshot),
            Rupture(Rupture),
        }
        pub struct Trajectory {
            info: Arc<RunInfo>,
        }
        impl Trajectory {
            pub fn open(file: &Path) -> Result<Self> {
                Err(crate::base::error::Error::io(
                    "cannot read",
                    file,
                    std::io::ErrorKind::NotFound.into(),
                ))
            }
            pub fn info(&self) -> &Arc<RunInfo> {
                &self.info
            }
            pub fn next_event(&mut self) -> Result<Option<Event>> {
                Ok(None)
            }
        }
    }
    #[cfg(feature = "record")]
    pub mod recording {
        use crate::base::error::Result;
        use crate::scene::spec::ColourBy;
        use std::path::Path;
        pub struct RecordingOptions {
            pub live: Option<String>,
            pub colour: ColourBy,
        }
        pub struct Recording;
        impl Recording {
            pub fn new(_file: &Path, _options: RecordingOptions) -> Result<Self> {
                Ok(Self)
            }
        }
        idle!(Recording);
    }
    pub(super) use idle;
}

#[cfg(feature = "render")]
pub mod render {
    use crate::base::error::{Error, Result};
    use crate::scene::spec::ColourBy;
    use std::path::Path;
    #[derive(Debug, Clone, PartialEq)]
    pub struct FrameOptions {
        pub size: [u32; 2],
        pub colour: ColourBy,
        pub views: Vec<View>,
        pub theme: Theme,
        pub camera: CameraOptions,
    }
    impl Default for FrameOptions {
        fn default() -> Self {
            Self {
                size: [1280, 720],
                colour: ColourBy::Stress,
                views: Vec::new(),
                theme: Theme::Dark,
                camera: CameraOptions::default(),
            }
        }
    }
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct CameraOptions {
        pub azimuth_deg: f32,
        pub elevation_deg: f32,
        pub zoom: f32,
        pub focus_z_mm: Option<f32>,
    }
    impl Default for CameraOptions {
        fn default() -> Self {
            Self {
                azimuth_deg: 0.0,
                elevation_deg: 0.0,
                zoom: 1.0,
                focus_z_mm: None,
            }
        }
    }
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum View {
        Overview,
        Midsection,
    }
    impl std::str::FromStr for View {
        type Err = Error;
        fn from_str(word: &str) -> Result<Self> {
            match word {
                "overview" => Ok(View::Overview),
                "midsection" => Ok(View::Midsection),
                _ => Err(Error::input(
                    format!("there is no view `{word}`"),
                    "views are …",
                )),
            }
        }
    }
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Theme {
        #[default]
        Dark,
        Light,
    }
    pub struct FrameWriter;
    impl FrameWriter {
        pub fn new(_folder: &Path, _options: FrameOptions) -> Result<Self> {
            Ok(Self)
        }
    }
    super::observe::idle!(FrameWriter);
    pub fn check() -> Result<()> {
        Ok(())
    }
}
