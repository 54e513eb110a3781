//! The page that sets the papers' figures and ours side by side: `docs/REPRODUCTION.md`.

use crate::store::Stored;
use crate::{Compare, Figure, Number, Paper, Verdict};
use std::fmt::Write as _;

/// What has a place on the page before it has a picture.
const TO_COME: [(Paper, &str, &str); 2] = [
    (
        Paper::TransforMesh,
        "figure 8",
        "Surfaces refined from photographs: the temple and the dinosaur of the multi-view evaluation.",
    ),
    (
        Paper::TransforMesh,
        "table 1",
        "Accuracy and completeness of those surfaces, beside other methods.",
    ),
];

const HEAD: &str = "\
# Reproduction

What the papers show, made by `cargo xtask figures` from the library's public calls. Each picture is there as PNG and as SVG,
with its numbers as JSON, in `docs/figures/`; `cargo test` makes each figure again with less effort and compares the
numbers with the stored ones. Numbers marked \u{2248} may differ a little between machines, those marked \u{2020} are times and
differ. The module that makes a figure is in `crates/figures/src/`.

**Agrees**: it shows the same. **Better**: the same, and what the paper leaves wrong or open is right. **Different**: it shows
something else, and the reason stands there.
";

/// The page of these figures, each with what is stored of it.
pub fn page(figures: &[(&Figure, Option<Stored>)]) -> String {
    let mut page = HEAD.to_owned();
    overview(&mut page, figures);
    for paper in Paper::ALL {
        let _ = write!(page, "\n## {}\n", paper.title());
        for (figure, stored) in figures.iter().filter(|(figure, _)| figure.paper == paper) {
            section(&mut page, figure, stored.as_ref());
        }
        for (_, number, shows) in TO_COME.iter().filter(|(of, ..)| *of == paper) {
            let _ = write!(page, "\n### {}: to come\n\n{shows}\n", capitalized(number));
        }
    }
    page
}

/// How many figures of each paper have which verdict.
fn overview(page: &mut String, figures: &[(&Figure, Option<Stored>)]) {
    page.push_str("\n| paper | figures | agrees | better | different | to come |\n|---|---|---|---|---|---|\n");
    for paper in Paper::ALL {
        let of = || {
            figures
                .iter()
                .filter(move |(figure, _)| figure.paper == paper)
        };
        let with = |verdict: Verdict| {
            of().filter(|(_, stored)| {
                stored
                    .as_ref()
                    .is_some_and(|stored| stored.full.verdict == verdict)
            })
            .count()
        };
        let announced = TO_COME.iter().filter(|(of, ..)| *of == paper).count();
        let unmade = of().filter(|(_, stored)| stored.is_none()).count();
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {} | {} |",
            paper.title(),
            of().count(),
            with(Verdict::Agrees),
            with(Verdict::Better),
            with(Verdict::Different),
            announced + unmade
        );
    }
}

fn section(page: &mut String, figure: &Figure, stored: Option<&Stored>) {
    let (number, title) = (capitalized(figure.number), figure.title);
    let Some(Stored { full, .. }) = stored else {
        let _ = write!(
            page,
            "\n### {number}: {title} (to come)\n\n{}\n",
            figure.shows
        );
        return;
    };
    let name = figure.name;
    let _ = write!(
        page,
        "\n### {number}: {title}\n\n**The paper** {}\n\n![{title}](figures/{name}.png)\n\n**Ours: {}.** {}\n",
        figure.shows,
        full.verdict.word(),
        full.because
    );
    if !full.numbers.is_empty() {
        page.push_str("\n| number | ours | paper |\n|---|---|---|\n");
        for number in &full.numbers {
            let paper = number.paper.as_deref().unwrap_or("");
            let _ = writeln!(
                page,
                "| {} | {} | {} |",
                cell(&number.name),
                value(number),
                cell(paper)
            );
        }
    }
    let _ = write!(
        page,
        "\n[SVG](figures/{name}.svg), [numbers](figures/{name}.json), `cargo xtask figures --only {name}`\n"
    );
}

fn value(number: &Number) -> String {
    let mark = match number.compare {
        Compare::Exactly => "",
        Compare::Within(_) => "≈ ",
        Compare::Not => "† ",
    };
    format!("{mark}{}", cell(&number.text()))
}

/// A `|` would end the cell.
fn cell(words: &str) -> String {
    words.replace('|', "\\|")
}

fn capitalized(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::Outcome;
    use crate::{Error, Made, Run};

    const FIGURE: Figure = Figure {
        name: "evolution-0",
        paper: Paper::Evolution,
        number: "figure 0",
        title: "Nothing",
        shows: "shows nothing.",
        make: nothing,
    };

    fn nothing(_: &Run<'_>) -> Result<Made, Error> {
        Err(Error::NotShown("nothing".into()))
    }

    #[test]
    fn what_is_stored_stands_on_the_page() {
        let outcome = Outcome {
            verdict: Verdict::Better,
            because: "Ours is empty too.".into(),
            numbers: vec![
                Number::within("|H|", 2.5, 0.1).paper("2"),
                Number::uncompared("time", 1.0).unit("s"),
            ],
        };
        let stored = Stored {
            full: outcome.clone(),
            quick: outcome,
        };
        let page = page(&[(&FIGURE, Some(stored))]);
        for expected in [
            "### Figure 0: Nothing\n\n**The paper** shows nothing.\n\n![Nothing](figures/evolution-0.png)",
            "**Ours: better.** Ours is empty too.",
            "| \\|H\\| | ≈ 2.500 | 2 |\n| time | † 1 s |  |\n",
            "direct surface evolution | 1 | 0 | 1 | 0 | 0 |",
            "### Table 1: to come",
        ] {
            assert!(page.contains(expected), "{expected:?} is not in\n{page}");
        }
    }

    #[test]
    fn what_is_not_stored_is_to_come() {
        let page = page(&[(&FIGURE, None)]);
        assert!(page.contains("### Figure 0: Nothing (to come)\n"));
        assert!(page.contains("direct surface evolution | 1 | 0 | 0 | 0 | 1 |"));
    }
}
