//! The shard of a task in a job array, and the rank of a process in an MPI job, by the variables
//! that schedulers and launchers set.

use crate::cli::note;
use crate::sweep::Plan;
use anyhow::{Result, bail};

/// The variables, innermost engine first: HyperQueue's workers may run inside an array of another.
/// Each with the index that its arrays begin at unless the plan states one.
const VARIABLES: [(&str, u32); 4] =
    [("HQ_TASK_ID", 0), ("SLURM_ARRAY_TASK_ID", 0), ("PBS_ARRAY_INDEX", 0), ("SGE_TASK_ID", 1)];

/// The variables by which launchers of MPI jobs and Slurm's `srun` tell a process its rank,
/// innermost launcher first: `mpirun` may run inside a job of Slurm.
const RANKS: [&str; 4] = ["OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"];

/// The value that Grid Engine sets outside arrays.
const UNDEFINED_VALUE: &str = "undefined";

/// The shard that the first variable that is set says; none where none is.
///
/// An array's own count and least index are not used: an array that is submitted again for a few
/// missing shards has others.
pub(super) fn of_task(
    plan: &Plan,
    variable: impl Fn(&str) -> Option<String>,
) -> Result<Option<u32>> {
    let set = |(name, first): (&'static str, u32)| {
        let value = variable(name).filter(|it| !it.is_empty() && it != UNDEFINED_VALUE)?;
        Some((name, plan.first.unwrap_or(first), value))
    };
    let Some((name, first, value)) = VARIABLES.into_iter().find_map(set) else { return Ok(None) };
    let index = value.parse::<u32>().ok().and_then(|it| it.checked_sub(first));
    let Some(shard) = index.filter(|it| *it < plan.shards) else {
        let last = u64::from(first) + u64::from(plan.shards) - 1;
        bail!(
            "{name} = {value} is no shard: accepted are {first} to {last}; the plan's key first \
             says where its array begins"
        );
    };
    note(&format!("{name} = {value}: this is shard {shard} of {}", plan.shards));
    Ok(Some(shard))
}

/// The rank of this process among those that share a sweep; 0 where no launcher says it.
pub(super) fn rank(variable: impl Fn(&str) -> Option<String>) -> u64 {
    RANKS.iter().find_map(|name| variable(name)?.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    fn plan(first: Option<u32>) -> Plan {
        Plan {
            verb: "lyapunov".to_owned(),
            shards: 4,
            first,
            words: Vec::new(),
            off: Vec::new(),
            axes: Vec::new(),
            hash: String::new(),
        }
    }

    fn shard(first: Option<u32>, set: &[(&str, &str)]) -> Result<Option<u32>> {
        let value = |name: &str| set.iter().find(|it| it.0 == name).map(|it| it.1.to_owned());
        of_task(&plan(first), value)
    }

    #[test]
    fn the_index_is_that_of_the_innermost_engine() {
        assert_eq!(shard(None, &[]).unwrap(), None);
        assert_eq!(shard(None, &[("SLURM_ARRAY_TASK_ID", "3")]).unwrap(), Some(3));
        assert_eq!(shard(None, &[("SGE_TASK_ID", "1")]).unwrap(), Some(0));
        assert_eq!(shard(None, &[("SGE_TASK_ID", "undefined")]).unwrap(), None);
        assert_eq!(shard(Some(1), &[("PBS_ARRAY_INDEX", "4")]).unwrap(), Some(3));
        let both = [("SLURM_ARRAY_TASK_ID", "3"), ("HQ_TASK_ID", "1")];
        assert_eq!(shard(None, &both).unwrap(), Some(1));
    }

    #[test]
    fn the_rank_is_that_of_the_innermost_launcher() {
        let of = |set: &[(&str, &str)]| {
            rank(|name| set.iter().find(|it| it.0 == name).map(|it| it.1.to_owned()))
        };
        assert_eq!(of(&[]), 0);
        assert_eq!(of(&[("PMI_RANK", "7")]), 7);
        assert_eq!(of(&[("SLURM_PROCID", "0"), ("OMPI_COMM_WORLD_RANK", "3")]), 3);
        assert_eq!(of(&[("PMIX_RANK", "")]), 0);
    }

    /// An array that is submitted again for shards 2 and 3 has another least index and count.
    #[test]
    fn an_array_for_missing_shards_fits() {
        let again = [
            ("SLURM_ARRAY_TASK_ID", "2"),
            ("SLURM_ARRAY_TASK_MIN", "2"),
            ("SLURM_ARRAY_TASK_COUNT", "2"),
        ];
        assert_eq!(shard(None, &again).unwrap(), Some(2));
    }

    #[test]
    fn an_index_outside_the_plan_is_refused() {
        for (first, value) in [(None, "4"), (Some(1), "0"), (None, "-1"), (None, "x")] {
            let error = shard(first, &[("SLURM_ARRAY_TASK_ID", value)]).unwrap_err().to_string();
            assert!(error.contains("SLURM_ARRAY_TASK_ID") && error.contains(value), "{error}");
            assert!(error.contains("accepted are"), "{error}");
        }
    }
}
