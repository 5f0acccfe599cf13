//! A study as the array of a batch system: scripts that run its cases one by one, and one that gathers them.
//!
//! Each case is a process of its own ([`numbered`](super::numbered)): kept under the hash of its scene, locked while it runs, and
//! gone on with where it was ended. So a case may be started twice or anew, and tables are those of a study on one machine.

use crate::base::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::str::FromStr;

/// A batch system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BatchSystem {
    /// Slurm: `sbatch`.
    Slurm,
    /// HyperQueue: `hq submit`.
    HyperQueue,
    /// GNU Parallel, on one machine or on several by ssh.
    GnuParallel,
}

impl BatchSystem {
    /// All of them, with the names by which they are asked for.
    pub const ALL: [(&'static str, Self); 3] =
        [("slurm", Self::Slurm), ("hq", Self::HyperQueue), ("gnu-parallel", Self::GnuParallel)];
}

impl FromStr for BatchSystem {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let found = Self::ALL.iter().find(|(name, _)| *name == text);
        let names = Self::ALL.map(|(name, _)| name).join(", ");
        found.map(|(_, system)| *system).ok_or_else(|| {
            Error::input(
                format!("`{text}` is no batch system that scripts are written for"),
                format!("those are {names}"),
            )
        })
    }
}

/// What scripts have to know of a study.
#[derive(Debug, Clone)]
pub struct Array<'a> {
    /// Its name.
    pub name: &'a str,
    /// Numbers of the cases that have to be run, from 1 on.
    pub cases: &'a [usize],
    /// The command without the number of a case, in words: the program and what follows.
    pub command: &'a [String],
    /// Where it is called.
    pub directory: &'a Path,
    /// The folder of the study.
    pub folder: &'a Path,
    /// What the longest case may take (s), where that is known.
    pub seconds: Option<f64>,
    /// What the largest case needs (bytes).
    pub bytes: f64,
    /// Whether cases need a graphics processor.
    pub adapter: bool,
}

/// Scripts, and what to type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scripts {
    /// Names of the files and what is in them.
    pub files: Vec<(&'static str, String)>,
    /// What to type in the folder in which they lie.
    pub commands: Vec<String>,
}

/// What the program itself takes (bytes).
const PROGRAM: f64 = 128e6;
/// Seconds before its end at which a case is told to keep what it has.
const NOTICE: u32 = 60;

impl Array<'_> {
    /// The scripts for a batch system.
    pub fn scripts(&self, system: BatchSystem) -> Scripts {
        match system {
            BatchSystem::Slurm => self.slurm(),
            BatchSystem::HyperQueue => self.hyper_queue(),
            BatchSystem::GnuParallel => self.gnu_parallel(),
        }
    }

    fn slurm(&self) -> Scripts {
        let (name, directory) = (self.job(), self.directory);
        let mut head = format!("#SBATCH --job-name={name}\n#SBATCH --array={}\n", ranges(self.cases));
        head += "#SBATCH --ntasks=1\n#SBATCH --cpus-per-task=1\n";
        if let Some(time) = self.minutes() {
            let _ = writeln!(head, "#SBATCH --time={}:{:02}:00", time / 60, time % 60);
        }
        let _ = writeln!(head, "#SBATCH --mem={}M", self.megabytes());
        let _ = writeln!(head, "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --signal=B:TERM@{NOTICE}");
        if self.adapter {
            head += "#SBATCH --gres=gpu:1\n";
        }
        // Beside the folder in which the scripts lie and are submitted: odd names of folders mean nothing to Slurm then.
        head += "#SBATCH --output=../log/%a.log\n";
        let array = format!(
            "#!/bin/bash
{head}
# A case that runs out of time keeps what it has and is queued again; one whose node fails is queued by Slurm.
cd {directory}
{command} --case \"$SLURM_ARRAY_TASK_ID\" &
case=$!
again() {{
    kill -TERM \"$case\"
    wait \"$case\"
    scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\"
    exit 0
}}
trap again TERM
wait \"$case\"
",
            directory = quoted(&directory.to_string_lossy()),
            command = self.command()
        );
        let collect = format!(
            "#!/bin/bash
#SBATCH --job-name={name}-collect
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --time=0:30:00
#SBATCH --mem={}M
#SBATCH --open-mode=append
#SBATCH --output=../log/collect.log

cd {}
{} --collect
",
            self.megabytes().max(1000),
            quoted(&directory.to_string_lossy()),
            self.command()
        );
        Scripts {
            files: vec![("cases.sbatch", array), ("collect.sbatch", collect)],
            commands: vec![
                "array=$(sbatch --parsable cases.sbatch)".into(),
                "sbatch --dependency=afterany:$array collect.sbatch".into(),
            ],
        }
    }

    fn hyper_queue(&self) -> Scripts {
        let time = self.minutes().map_or(String::new(), |time| format!(" --time-request {time}min"));
        let submit = format!(
            "#!/bin/bash
# Cases as an array of HyperQueue, and what gathers them once all have ended.
set -e
cd {directory}
job=$(hq submit --array {cases} --name {name} --cpus 1{adapter}{time} --crash-limit 10 \\
    --stream {log} --output-mode id -- /bin/bash -c {each})
hq job wait \"$job\" || true
{command} --collect
",
            directory = quoted(&self.directory.to_string_lossy()),
            cases = ranges(self.cases),
            name = self.job(),
            adapter = if self.adapter { " --resource gpus/nvidia=1" } else { "" },
            log = quoted(&self.folder.join("log/hq").to_string_lossy()),
            each = quoted(&format!("{} --case \"$HQ_TASK_ID\"", self.command())),
            command = self.command()
        );
        Scripts { files: vec![("submit.sh", submit)], commands: vec!["bash submit.sh".into()] }
    }

    fn gnu_parallel(&self) -> Scripts {
        let numbers: Vec<String> = self.cases.iter().map(usize::to_string).collect();
        let case = format!(
            "#!/bin/bash
# A case by its number.
cd {}
exec {} --case \"$1\"
",
            quoted(&self.directory.to_string_lossy()),
            self.command()
        );
        // What parallel itself reads must not have braces from names of folders in it.
        let all = format!(
            "#!/bin/bash
# Cases side by side, one per core, each started only where its memory is free; then what gathers them. Called again, it goes
# on with those that are missing. --sshloginfile takes them to other machines that share this folder.
cd \"$(dirname \"$0\")\"
parallel --jobs 100% --memfree {megabytes}M --joblog ../log/cases.tsv --results ../log/{{}}.log bash ./case.sh {{}} \\
    ::: {numbers}
cd {directory}
{command} --collect
",
            megabytes = self.megabytes(),
            numbers = numbers.join(" "),
            directory = quoted(&self.directory.to_string_lossy()),
            command = self.command()
        );
        Scripts { files: vec![("case.sh", case), ("cases.sh", all)], commands: vec!["bash cases.sh".into()] }
    }

    /// The command for a shell.
    fn command(&self) -> String {
        self.command.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
    }

    /// The study's name as that of a job: names of files may have anything in them.
    fn job(&self) -> String {
        let plain = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
        self.name.chars().map(plain).collect()
    }

    /// Time of a case with room to end (min).
    fn minutes(&self) -> Option<u64> {
        self.seconds.map(|seconds| ((seconds + f64::from(NOTICE)) / 300.0).ceil() as u64 * 5 + 5)
    }

    fn megabytes(&self) -> u64 {
        ((self.bytes + PROGRAM) / 50e6).ceil() as u64 * 50
    }
}

/// A word for a shell.
pub fn quoted(word: &str) -> String {
    let plain = !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || "-_./=,%+:".contains(c));
    if plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// Numbers in rising order as batch systems take them: 1-3,7.
fn ranges(numbers: &[usize]) -> String {
    let mut parts: Vec<[usize; 2]> = Vec::new();
    for number in numbers {
        match parts.last_mut() {
            Some([_, last]) if *last + 1 == *number => *last = *number,
            _ => parts.push([*number; 2]),
        }
    }
    let part = |[first, last]: [usize; 2]| if first == last { first.to_string() } else { format!("{first}-{last}") };
    parts.into_iter().map(part).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scripts(system: &str) -> Scripts {
        let command = ["/opt/strandsnap", "study", "a b.toml", "--seeds", "1..3"].map(str::to_owned);
        let (directory, folder) = (Path::new("/home/it's me"), Path::new("/data/out/study/many"));
        let cases = [1, 2, 3, 7, 9, 10];
        let array = Array {
            name: "it's many",
            cases: &cases,
            command: &command,
            directory,
            folder,
            seconds: Some(500.0),
            bytes: 3e8,
            adapter: true,
        };
        array.scripts(system.parse().unwrap())
    }

    #[test]
    fn an_array_is_of_the_cases_that_are_missing() {
        assert_eq!(ranges(&[1, 2, 3, 7, 9, 10]), "1-3,7,9-10");
        assert_eq!((ranges(&[4]), ranges(&[])), ("4".into(), String::new()));
    }

    #[test]
    fn a_script_of_slurm_asks_for_what_the_longest_and_the_largest_case_need() {
        let Scripts { files, commands } = scripts("slurm");
        let (name, array) = &files[0];
        assert_eq!(*name, "cases.sbatch");
        for line in [
            "#SBATCH --array=1-3,7,9-10\n",
            "#SBATCH --time=0:15:00\n",
            "#SBATCH --mem=450M\n",
            "#SBATCH --job-name=it-s-many\n",
            "#SBATCH --gres=gpu:1\n",
            "#SBATCH --output=../log/%a.log\n",
            "cd '/home/it'\\''s me'\n",
            "/opt/strandsnap study 'a b.toml' --seeds 1..3 --case \"$SLURM_ARRAY_TASK_ID\" &\n",
        ] {
            assert!(array.contains(line), "{line} is not in\n{array}");
        }
        assert!(files[1].1.ends_with("/opt/strandsnap study 'a b.toml' --seeds 1..3 --collect\n"));
        assert!(commands[1].contains("afterany:$array"));
    }

    #[test]
    fn shells_take_every_script() {
        for (name, _) in BatchSystem::ALL {
            for (file, text) in scripts(name).files {
                let folder = tempfile::tempdir().unwrap();
                let path = folder.path().join(file);
                std::fs::write(&path, &text).unwrap();
                let checked = std::process::Command::new("bash").arg("-n").arg(&path).output().unwrap();
                assert!(checked.status.success(), "{}\n{text}", String::from_utf8_lossy(&checked.stderr));
            }
        }
    }

    #[test]
    fn another_system_is_refused_with_those_that_there_are() {
        let error = "pbs".parse::<BatchSystem>().unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(format!("{error:?}").contains("slurm, hq, gnu-parallel"));
    }
}
