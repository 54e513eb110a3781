//! The commands that README.md tells its reader to run.

/// The commands of the fenced `sh` blocks, one a line, comments and continuation lines resolved.
fn shell_commands(readme: &str) -> Vec<String> {
    let mut commands = Vec::new();
    let mut inside = false;
    let mut pending = String::new();
    for line in readme.lines() {
        let line = line.trim();
        if let Some(language) = line.strip_prefix("```") {
            inside = !inside && language == "sh";
            continue;
        }
        if !inside || line.is_empty() || line.starts_with('#') {
            continue;
        }
        match line.strip_suffix('\\') {
            Some(start) => pending.push_str(start),
            None => {
                pending.push_str(line);
                commands.push(std::mem::take(&mut pending));
            }
        }
    }
    commands
}

/// The commands that run the program.
pub fn run_commands(readme: &str) -> Vec<String> {
    let mut commands = shell_commands(readme);
    commands.retain(|command| command.starts_with("cargo run"));
    commands
}

/// The one command that runs the tests.
pub fn test_command(readme: &str) -> Result<String, String> {
    let mut tests: Vec<String> = shell_commands(readme)
        .into_iter()
        .filter(|command| command.starts_with("cargo test"))
        .collect();
    match (tests.pop(), tests.is_empty()) {
        (Some(command), true) => Ok(command),
        (None, _) => Err("README.md shows no `cargo test …` in a ```sh block".into()),
        (Some(_), false) => Err("README.md shows more than one `cargo test …`".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const README: &str = "\
# A
`cargo test --nothing`
```sh
# make a mesh
cargo run --release -- x \\
  -o y
cargo test --workspace
```
```rust
cargo test --not-shell
```
";

    #[test]
    fn commands_come_from_shell_blocks_only() {
        assert_eq!(
            shell_commands(README),
            ["cargo run --release -- x -o y", "cargo test --workspace"]
        );
        assert_eq!(run_commands(README), ["cargo run --release -- x -o y"]);
    }

    #[test]
    fn exactly_one_test_command() {
        assert_eq!(
            test_command(README).as_deref(),
            Ok("cargo test --workspace")
        );
        assert!(test_command("").is_err());
        assert!(test_command(&format!("{README}{README}")).is_err());
    }
}
