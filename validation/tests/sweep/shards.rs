//! Shards: lost, damaged, computed twice or at the same time, the arrays are those of one run.

use super::{Case, DRIFT};
use crate::support::{percuss, text};
use std::fs;
use std::path::Path;

#[test]
fn a_shard_that_was_cut_or_altered_or_is_of_another_sweep_is_named_and_redone() {
    let case = Case::drift(4);
    case.done("run", &[]);
    let expected = case.merged();
    let whole = fs::read(case.shard(2)).expect("read");
    let other = Case::new(&DRIFT.replace("SHARDS", "4").replace("0.02", "0.03"));
    other.done("run", &[]);
    let mut spoiled: Vec<(Vec<u8>, &str)> = vec![
        (Vec::new(), "truncated"),
        (whole[..whole.len() - 1].to_vec(), "checksum"),
        (whole[..whole.len() / 2].to_vec(), "checksum"),
        (b"not a shard".to_vec(), "truncated"),
        (fs::read(other.shard(2)).expect("read"), "another plan"),
        (fs::read(case.shard(1)).expect("read"), "wrong name"),
    ];
    // One bit at places all over the file.
    for place in (0..whole.len()).step_by(whole.len() / 20) {
        let mut altered = whole.clone();
        altered[place] ^= 1 << (place % 8);
        spoiled.push((altered, "checksum"));
    }
    for (bytes, why) in spoiled {
        fs::write(case.shard(2), &bytes).expect("written");
        let (code, status) = case.status();
        assert_eq!(code, Some(1));
        assert_eq!(status["damaged"][0]["shard"], 2, "{status}");
        let before = fs::read(case.path("merged.npz")).expect("read");
        let output = case.path("merged.npz");
        let (code, _, said) = case.run("merge", &["--output", &output]);
        assert_eq!(code, Some(1), "{said}");
        assert!(said.contains("shard 2 is damaged") && said.contains(why), "{said}");
        assert_eq!(fs::read(&output).expect("read"), before, "the old file stays");
        let said = case.done("run", &[]);
        assert!(said.contains("shard 2") && said.contains("again"), "{said}");
        assert_eq!(case.merged(), expected);
    }
}

#[test]
fn a_finished_shard_is_skipped_and_a_missing_one_is_named() {
    let case = Case::drift(4);
    let (code, status) = case.status();
    assert_eq!(code, Some(1));
    assert_eq!(status["missing"].as_array().map(Vec::len), Some(4));
    assert!(!Path::new(&case.path("out")).exists(), "status makes no folder");
    case.done("run", &["--shard", "1/4"]);
    let modified = |case: &Case| fs::metadata(case.shard(1)).and_then(|it| it.modified()).ok();
    let first = modified(&case);
    case.done("run", &["--shard", "1/4"]);
    assert_eq!(modified(&case), first);
    let (_, status) = case.status();
    assert_eq!(status["done"], serde_json::json!([1]));
    assert!(status["seconds_to_end"].as_f64().is_some_and(|it| it >= 0.0), "{status}");
    let output = case.path("merged.npz");
    let (code, _, said) = case.run("merge", &["--output", &output]);
    assert_eq!(code, Some(1));
    assert!(said.contains("shard 0 is missing") && said.contains("sweep run"), "{said}");
    assert!(!Path::new(&output).exists());
}

#[test]
fn engines_give_the_index_and_an_array_for_two_missing_shards_fits() {
    let case = Case::drift(4);
    let task = |variables: &[(&str, &str)]| {
        let words = case.command("run", &[]);
        let mut command = percuss(&words.iter().map(String::as_str).collect::<Vec<_>>());
        variables.iter().for_each(|(name, value)| {
            command.env(name, value);
        });
        let output = command.output().expect("run");
        (output.status.code(), text(&output.stderr))
    };
    let array = ("SLURM_ARRAY_TASK_COUNT", "2");
    assert_eq!(task(&[("SLURM_ARRAY_TASK_ID", "3"), array]).0, Some(0));
    assert_eq!(case.status().1["done"], serde_json::json!([3]));
    assert_eq!(task(&[("HQ_TASK_ID", "0")]).0, Some(0));
    assert_eq!(task(&[("PBS_ARRAY_INDEX", "1")]).0, Some(0));
    assert_eq!(task(&[("SGE_TASK_ID", "3")]).0, Some(0));
    assert_eq!(case.status().0, Some(0));
    let (code, said) = task(&[("SLURM_ARRAY_TASK_ID", "4")]);
    assert_eq!(code, Some(2));
    assert!(said.contains("SLURM_ARRAY_TASK_ID = 4") && said.contains("0 to 3"), "{said}");
}

/// Two runs of all shards at once, and a third one that is told one shard: each shard is there
/// once, and the arrays are those of one run.
#[test]
fn workers_at_the_same_time_lose_and_double_nothing() {
    let alone = Case::drift(4);
    alone.done("run", &[]);
    let case = Case::drift(4);
    let start = |more: &[&str]| {
        let mut command = std::process::Command::new(percuss(&[]).get_program());
        command.args(case.command("run", more)).stderr(std::process::Stdio::null());
        command.spawn().expect("started")
    };
    let workers = [start(&[]), start(&[]), start(&["--shard", "2/4"])];
    for mut worker in workers {
        assert!(worker.wait().expect("ended").success());
    }
    assert_eq!(case.merged(), alone.merged());
    let names = fs::read_dir(case.path("out")).expect("read");
    let names: Vec<String> =
        names.map(|it| it.expect("an entry").file_name().to_string_lossy().into()).collect();
    assert!(names.iter().all(|it| !it.ends_with(".tmp") && !it.ends_with(".lock")), "{names:?}");
}

#[test]
fn what_a_killed_worker_has_left_is_removed() {
    let case = Case::drift(4);
    case.done("run", &["--shard", "0/4"]);
    let left = ["00002.lock", ".percuss-00002-abcdef.tmp", ".percuss-00003-abcdef.tmp"];
    let left = left.map(|name| case.folder.path().join("out").join(name));
    left.iter().for_each(|path| fs::write(path, "").expect("written"));
    case.done("run", &["--shard", "2/4"]);
    // Another shard's may be another worker's, which is at it.
    assert_eq!(left.map(|path| path.exists()), [false, false, true]);
}

/// The processes of an MPI job, one more than there are shards: each shard is there
/// once, and only the first process says what it finds.
#[test]
fn ranks_share_the_shards() {
    let alone = Case::drift(4);
    alone.done("run", &[]);
    let case = Case::drift(4);
    case.done("run", &["--shard", "1/4"]);
    fs::write(case.shard(1), "spoiled").expect("written");
    let start = |rank: u32| {
        let words = case.command("run", &[]);
        let mut command = percuss(&words.iter().map(String::as_str).collect::<Vec<_>>());
        command.env("OMPI_COMM_WORLD_RANK", rank.to_string());
        std::thread::spawn(move || command.output().expect("run"))
    };
    let ranks: Vec<_> = (0..5).map(start).collect();
    for (rank, started) in ranks.into_iter().enumerate() {
        let output = started.join().expect("no panic");
        let said = text(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(rank == 0 || said.is_empty(), "{rank}: {said}");
    }
    assert_eq!(case.merged(), alone.merged());
}

/// The lock of a machine that is lost may stay on a file system that others share: whoever waits
/// for it computes the shard in the end.
#[test]
fn a_shard_whose_lock_stays_is_computed_by_another() {
    let alone = Case::drift(4);
    alone.done("run", &[]);
    let case = Case::drift(4);
    case.done("run", &["--shard", "3/4"]);
    let lock = fs::File::create(case.folder.path().join("out/00001.lock")).expect("created");
    lock.lock().expect("locked");
    assert_eq!(case.status().1["running"], serde_json::json!([1]));
    case.done("run", &[]);
    assert_eq!(case.merged(), alone.merged());
}
