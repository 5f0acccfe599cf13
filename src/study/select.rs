//! Choosing among things that have names, on the command line.

use crate::base::error::{Error, Result};
use crate::scene::suggest::nearest;

/// Those of `all` that are called by `names`, in the order of `all`; everything when no name is given. A name that ends
/// with `*` takes all that begin so. `what` is such a thing ("verification case"), `list` the command that names them all.
///
/// # Errors
/// A name that nothing has; the nearest is suggested.
pub fn select<'a, T>(
    names: &[String],
    all: &'a [T],
    name_of: impl Fn(&T) -> &str,
    what: &str,
    list: &str,
) -> Result<Vec<&'a T>> {
    let called = |name: &str, one: &T| match name.strip_suffix('*') {
        Some(start) => name_of(one).starts_with(start),
        None => name_of(one) == name,
    };
    if let Some(name) = names.iter().find(|name| !all.iter().any(|one| called(name, one))) {
        let near = nearest(name, all.iter().map(&name_of));
        let guess = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let help = format!("{guess}`{list}` names them all; `{name}*` would take all that begin so");
        return Err(Error::input(format!("there is no {what} `{name}`"), help));
    }
    Ok(all.iter().filter(|one| names.is_empty() || names.iter().any(|name| called(name, one))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stars_and_mistakes() {
        let all = ["friction-low", "friction-high", "step"];
        let chosen = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| name.to_string()).collect();
            select(&names, &all, |name| name, "case", "list").map(|some| some.into_iter().copied().collect::<Vec<_>>())
        };
        assert_eq!(chosen(&[]).unwrap(), all);
        assert_eq!(chosen(&["step", "friction-*"]).unwrap(), all);
        assert_eq!(chosen(&["friction-high"]).unwrap(), ["friction-high"]);
        let error = chosen(&["stp"]).unwrap_err();
        assert_eq!((error.to_string().as_str(), error.exit_code()), ("there is no case `stp`", 2));
        let Error::Input { help: Some(help), .. } = error else { unreachable!() };
        assert!(help.starts_with("did you mean `step`?"), "{help}");
    }
}
