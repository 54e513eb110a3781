//! What stands behind `--delaunay`.

use super::{INPUTS, QUICK};

/// What is to be measured, and how.
#[derive(Debug, PartialEq)]
pub struct Arguments {
    /// `KIND:COUNT` or `file:PATH` each.
    pub inputs: Vec<String>,
    /// Runs of each program on each input.
    pub rounds: usize,
    /// The numbers of threads with which programs that know threads are run.
    pub threads: Vec<usize>,
    /// Whether the exact checker looks at the results.
    pub check: bool,
    /// Whether what was measured before stays, but for these inputs.
    pub keep: bool,
    /// Whether this is but a look at small inputs, whose figures stay out of the documentation.
    pub quick: bool,
    /// Only these programs beside ours, if any are named.
    pub only: Option<Vec<String>>,
}

impl Default for Arguments {
    fn default() -> Self {
        Self {
            inputs: Vec::new(),
            rounds: 5,
            threads: vec![1, 2],
            check: true,
            keep: false,
            quick: false,
            only: None,
        }
    }
}

impl Arguments {
    /// Reads the words; without inputs, all of [`INPUTS`].
    pub fn parse(words: &[&str]) -> Result<Self, String> {
        let mut arguments = Self::default();
        let mut page = false;
        let mut words = words.iter();
        while let Some(&word) = words.next() {
            let mut value = || {
                words
                    .next()
                    .copied()
                    .ok_or_else(|| format!("{word} wants a value"))
            };
            match word {
                "--quick" => arguments.quick = true,
                "--page" => (page, arguments.keep) = (true, true),
                "--keep" => arguments.keep = true,
                "--no-check" => arguments.check = false,
                "--rounds" => arguments.rounds = number(value()?)?,
                "--threads" => {
                    let numbers = value()?.split(',').map(number);
                    arguments.threads = numbers.collect::<Result<_, _>>()?;
                }
                "--only" => {
                    let names = value()?.split(',').map(str::to_lowercase);
                    arguments.only = Some(names.collect());
                }
                input if input.contains(':') && !input.starts_with('-') => {
                    arguments.inputs.push(input.to_owned());
                }
                other => return Err(format!("bench --delaunay does not know {other}")),
            }
        }
        if arguments.quick {
            arguments.inputs.extend(QUICK.map(str::to_owned));
            arguments.rounds = arguments.rounds.min(3);
        }
        if arguments.inputs.is_empty() && !page {
            arguments.inputs = INPUTS.map(str::to_owned).into();
        }
        Ok(arguments)
    }

    /// Whether a program beside ours is wanted.
    pub fn wants(&self, name: &str) -> bool {
        self.only
            .as_ref()
            .is_none_or(|names| names.iter().any(|wanted| *wanted == name.to_lowercase()))
    }
}

/// A number above zero.
fn number(word: &str) -> Result<usize, String> {
    match word.parse() {
        Ok(0) | Err(_) => Err(format!("{word} is not a number above zero")),
        Ok(number) => Ok(number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read() {
        let arguments = Arguments::parse(&[
            "--rounds",
            "7",
            "torus:1000",
            "--threads",
            "1,4",
            "--only",
            "CGAL,hxt",
            "--no-check",
        ])
        .unwrap();
        assert_eq!(arguments.inputs, ["torus:1000"]);
        assert_eq!((arguments.rounds, arguments.check), (7, false));
        assert_eq!(arguments.threads, [1, 4]);
        assert!(arguments.wants("HXT") && arguments.wants("cgal") && !arguments.wants("TetGen"));
    }

    #[test]
    fn without_inputs_all_of_them_are_measured() {
        assert_eq!(Arguments::parse(&[]).unwrap().inputs, INPUTS);
        let quick = Arguments::parse(&["--quick"]).unwrap();
        assert_eq!(
            (&quick.inputs[..], quick.quick),
            (&QUICK.map(str::to_owned)[..], true)
        );
        assert!(Arguments::parse(&["--page"]).unwrap().inputs.is_empty());
        assert!(Arguments::default().wants("TetGen"));
    }

    #[test]
    fn mistakes_are_named() {
        for words in [
            &["--rounds", "0"][..],
            &["--rounds"],
            &["--threads", "1,x"],
            &["uniform"],
            &["--torus:5"],
        ] {
            assert!(Arguments::parse(words).is_err(), "{words:?}");
        }
    }
}
