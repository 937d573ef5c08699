//! The order that each method claims.

/// The order of convergence that a method's authors state, where it has one: methods of variable
/// order and closed forms have none.
#[must_use]
pub fn claimed_order(engine: &str) -> Option<u32> {
    let order = match engine {
        "diffsol-tr_bdf2" => 2,
        // Its library: "a third order ESDIRK method"; the 4 of its name is the order of the
        // solution that only estimates the error.
        "diffsol-esdirk34" => 3,
        "ode_solvers-rk4" => 4,
        "diffsol-tsit45"
        | "ode_solvers-dopri5"
        | "ode_solvers-dopri5-original"
        | "differential-equations-radau5"
        | "differential-equations-kvaerno745" => 5,
        "differential-equations-rkv655e"
        | "differential-equations-rkv655e-original"
        | "differential-equations-rkv655e-events" => 6,
        "differential-equations-rkv767e" => 7,
        "ode_solvers-dop853" | "ode_solvers-dop853-time" | "differential-equations-dop853" => 8,
        _ => return None,
    };
    Some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_closed_forms_and_variable_orders_claim_none() {
        let none = super::super::all().iter().map(|it| it.declaration().name);
        let none: Vec<_> = none.filter(|name| claimed_order(name).is_none()).collect();
        assert_eq!(none, ["exact", "diffsol-bdf", "differential-equations-bdf"]);
    }
}
