//! Every figure, made with less effort, gives the numbers that are stored: what `cargo xtask figures --quick` checks. A
//! test a paper, so that they run side by side.

use pellicle::geometry::Progress;
use pellicle_figures::store::{self, Outcome};
use pellicle_figures::{Effort, Error, Figure, Paper, Run, figures, page, raster};
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Makes the paper's figures, and lists everything that is not as stored.
fn check(paper: Paper) {
    let mut findings = Vec::new();
    for figure in figures().filter(|figure| figure.paper == paper) {
        match differences(figure) {
            Ok(lines) => {
                findings.extend(lines.iter().map(|line| format!("{}: {line}", figure.name)))
            }
            Err(error) => findings.push(format!("{}: {error}", figure.name)),
        }
    }
    assert!(findings.is_empty(), "{}", findings.join("\n"));
}

fn differences(figure: &Figure) -> Result<Vec<String>, pellicle_figures::Error> {
    let run = Run {
        effort: Effort::Quick,
        progress: &(),
    };
    let outcome = Outcome::of(&(figure.make)(&run)?)?;
    Ok(match store::read(&store::folder(), figure)? {
        Some(stored) => stored.quick.differences(&outcome),
        None => vec!["nothing is stored".into()],
    })
}

#[test]
fn robustness() {
    check(Paper::Robustness);
}

#[test]
fn cocone() {
    check(Paper::Cocone);
}

#[test]
fn transformesh() {
    check(Paper::TransforMesh);
}

#[test]
fn evolution() {
    check(Paper::Evolution);
}

#[test]
fn names_are_file_stems_and_differ() {
    let mut names = BTreeSet::new();
    for figure in figures() {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(figure.name.chars().all(plain), "{}", figure.name);
        assert!(names.insert(figure.name), "{} is there twice", figure.name);
    }
}

#[test]
fn every_figure_has_its_files_and_no_file_is_left_over() {
    let mut expected = BTreeSet::new();
    for figure in figures() {
        for extension in ["json", "png", "svg"] {
            expected.insert(format!("{}.{extension}", figure.name));
        }
    }
    let found: BTreeSet<String> = std::fs::read_dir(store::folder())
        .expect("the folder of figures")
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn the_page_is_that_of_the_stored_numbers() {
    let stored: Vec<_> = figures()
        .map(|figure| {
            (
                figure,
                store::read(&store::folder(), figure).expect("stored numbers"),
            )
        })
        .collect();
    let path = store::folder().with_file_name("REPRODUCTION.md");
    let page = std::fs::read_to_string(path).expect("the page");
    assert!(page == page::page(&stored), "run `cargo xtask figures`");
}

#[test]
fn a_sheet_is_the_same_every_time() {
    let run = Run {
        effort: Effort::Quick,
        progress: &(),
    };
    for name in ["robustness-turn", "robustness-choices"] {
        let figure = figures()
            .find(|figure| figure.name == name)
            .expect("the figure");
        let [one, other] = [(); 2].map(|()| (figure.make)(&run).expect("a figure").sheet.svg());
        assert!(one == other, "{name}");
        let [one, other] = [one, other].map(|svg| raster::png(&svg).expect("a picture"));
        assert!(one == other, "{name}");
    }
}

#[test]
fn an_observer_stops_a_figure() {
    struct Stop;
    impl Progress for Stop {
        fn step(&self, _: &'static str, _: u64, _: u64) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }
    let figure = figures()
        .find(|figure| figure.name == "robustness-conflict")
        .expect("the figure");
    let made = (figure.make)(&Run {
        effort: Effort::Full,
        progress: &Stop,
    });
    assert!(matches!(made, Err(Error::Cancelled(_))));
}
