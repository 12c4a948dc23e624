//! The command line: the commands, what they print, and the codes with which they end.

pub mod cases;
pub mod healthcheck;
mod in_order;
pub mod licences;
mod output;
pub mod validate;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::LazyLock;
use std::{env, fs};

use clap::error::ContextValue;
use clap::{ArgAction, CommandFactory, Parser, Subcommand};
use clap_complete::Shell;
use reentry::integrate::{LaneInstructions, lane_instructions, use_lanes};

use crate::answer;
use crate::cli::cases::{Cases, States};
use crate::cli::healthcheck::Healthcheck;
use crate::cli::licences::Licences;
use crate::cli::output::Output;
use crate::cli::validate::Validate;
use crate::config::Config;
use crate::endpoints::planets::Planets;
use crate::format::Format;
use crate::router::document;
use crate::wire::shown::printable;
use crate::wire::space_weather::{self, Records};

/// Simulates atmospheric entry: trajectories, landing points, loads and heating.
#[derive(Debug, Parser)]
#[command(name = "reentry", version, long_version = LONG_VERSION.as_str(), arg_required_else_help = true, after_help = EXIT_CODES)]
pub struct Cli {
    /// File of space-weather indices for cases with `"indices": "file"`: `SW-All.csv` or `SW-All.txt` of CelesTrak, or
    /// `Kp_ap_Ap_SN_F107_since_1932.txt` of the GFZ
    #[arg(long, global = true, env = "REENTRY_SPACE_WEATHER", value_name = "FILE")]
    pub space_weather: Option<PathBuf>,

    /// Whether the flights of a search share the vector registers of the processor, where it has AVX2 or AVX-512: 0 or 1. The answers are the same
    #[arg(long, global = true, env = LANES, value_name = "0|1", default_value = "1", action = ArgAction::Set, value_parser = lanes)]
    pub lanes: bool,

    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The environment variable by which lanes are turned off.
const LANES: &str = "REENTRY_LANES";

/// What `--version` says: the version, and the instructions of the lanes in which searches fly.
static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let are_off = env::var(LANES).is_ok_and(|text| lanes(&text) == Ok(false));
    let instructions = lane_instructions().filter(|_| !are_off).unwrap_or("none");
    format!("{}\nlanes: {instructions}", env!("CARGO_PKG_VERSION"))
});

/// Whether there are to be lanes.
///
/// # Errors
/// With what the text must be.
fn lanes(text: &str) -> Result<bool, String> {
    match text {
        "0" => Ok(false),
        "1" => Ok(true),
        _ => Err("must be 0 or 1".to_owned()),
    }
}

/// What the program can do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the web service until SIGTERM, SIGINT or SIGQUIT; each flag can also be set by its environment variable
    Serve(Box<Config>),
    /// Simulate one case or a list of cases: the JSON of POST /simulate
    #[command(after_help = [SIMULATE_EXAMPLES, EXIT_CODES].concat())]
    Simulate {
        /// The cases.
        #[command(flatten)]
        cases: Cases,

        /// Output format
        #[arg(long, short, value_parser = Format::offered(&Format::OF_FLIGHTS), default_value = "json")]
        format: Format,
    },
    /// Compare a closed-form theory with the simulated flight, for one case or a list: the JSON of POST /analytic
    #[command(after_help = [ANALYTIC_EXAMPLES, EXIT_CODES].concat())]
    Analytic {
        /// The cases.
        #[command(flatten)]
        cases: Cases,

        /// Output format
        #[arg(long, short, value_parser = Format::offered(&Format::OF_THEORIES), default_value = "json")]
        format: Format,
    },
    /// Find numbers of a case with which its flight achieves goals, for one case or a list: the JSON of POST /target
    #[command(after_help = [TARGET_EXAMPLES, EXIT_CODES].concat())]
    Target {
        /// The cases.
        #[command(flatten)]
        cases: States,

        /// Output format; a target is available only as JSON
        #[arg(long, short, value_parser = ["json"], default_value = "json")]
        format: String,
    },
    /// Find the values of a number with which flights keep limits, for one case or a list: the JSON of POST /corridor
    #[command(after_help = [CORRIDOR_EXAMPLES, EXIT_CODES].concat())]
    Corridor {
        /// The cases.
        #[command(flatten)]
        cases: States,

        /// Output format; a corridor is available only as JSON
        #[arg(long, short, value_parser = ["json"], default_value = "json")]
        format: String,
    },
    /// Find the ground that flights reach, for one case or a list: the JSON of POST /footprint
    #[command(after_help = [FOOTPRINT_EXAMPLES, EXIT_CODES].concat())]
    Footprint {
        /// The cases.
        #[command(flatten)]
        cases: States,

        /// Output format
        #[arg(long, short, value_parser = Format::offered(&Format::OF_FOOTPRINTS), default_value = "json")]
        format: Format,
    },
    /// Convert one state or a list of states to all coordinate systems: the JSON of POST /convert
    #[command(after_help = [CONVERT_EXAMPLES, EXIT_CODES].concat())]
    Convert {
        /// The states.
        #[command(flatten)]
        states: States,

        /// Output format; a state is available only as JSON
        #[arg(long, short, value_parser = ["json"], default_value = "json")]
        format: String,
    },
    /// Run the built-in reference cases and print expected and computed values: the JSON of GET /validation
    #[command(after_help = [VALIDATE_EXAMPLES, EXIT_CODES].concat())]
    Validate(Validate),
    /// List the planets that a case may name, with their numbers and sources: the JSON of GET /planets
    Planets,
    /// Check whether the service on this machine is running; for containers without another HTTP client
    Healthcheck(Healthcheck),
    /// Print the licences of the program and of everything in it: GET /licences
    Licences(Licences),
    /// Print the OpenAPI document
    Openapi,
    /// Print a completion script for a shell
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// Shell
        shell: Shell,
    },
}

const EXIT_CODES: &str = "\
Exit codes:
  0  success
  1  a case failed (it is not valid, its flight cannot be completed, or a reference case differs from the expected result), or
     the service cannot listen or does not answer
  2  the command line or a setting is not valid
  3  a file cannot be read or written, or standard output is closed
";

const SIMULATE_EXAMPLES: &str = r#"Examples:
  reentry simulate case.json
  reentry simulate case.json --format csv --output trajectory.csv
  reentry simulate case.json --format kml --output track.kml
  reentry simulate case.json --format oem --output states.oem
  reentry simulate - < case.json | jq .final_state
  reentry simulate cases.json > answers.ndjson
  reentry simulate - --format csv <<'END'
  {"angle_unit": "deg", "atmosphere": {"type": "us76"},
   "vehicle": {"mass": 5500, "reference_area": 12, "aerodynamics": {"type": "constant", "drag_coefficient": 1.3}},
   "initial_state": {"type": "planet_relative", "altitude": 120000, "longitude": 0, "geocentric_latitude": 10,
     "speed": 7500, "flight_path_angle": -3, "heading": 30}}
  END

A list of cases, a JSON array, gives one line of JSON per case, in order. A failed case is reported on standard error and its line
holds the problem document; the others still run. With --format csv, a list gives one table whose first column, case, counts from 0.
With geojson and czml, it gives one map per line. kml and oem accept only a single case.

"#;

const ANALYTIC_EXAMPLES: &str = r#"Examples:
  reentry analytic case.json --format csv
  jq '.solution = "steep_ballistic"' case.json | reentry analytic - | jq .valid

The field solution of a case names the theory: shallow_glide, loh, steep_glide, steep_ballistic or medium_glide.

"#;

const TARGET_EXAMPLES: &str = r"Examples:
  reentry target case.json | jq '.solutions[] | [.values, .distance]'
  reentry target case.json | jq '.solutions[0].case' | reentry simulate -

The field vary of a case names numbers and their ranges, achieve what its flight must achieve. A case whose goals are out of reach is
no failure: outcome and nearest say so.

";

const CORRIDOR_EXAMPLES: &str = r"Examples:
  reentry corridor case.json | jq '.bands[] | [.from, .to]'

The field vary of a case names the number and its range, limits what its flights must keep.

";

const FOOTPRINT_EXAMPLES: &str = r"Examples:
  reentry footprint case.json | jq '.area, .extent'
  reentry footprint case.json --format geojson --output footprint.geojson

The field vary of a case names numbers and their ranges, limits what its flights must keep.

";

const CONVERT_EXAMPLES: &str = r#"Examples:
  reentry convert state.json
  echo '{"state": {"type": "ecef", "position": [7e6, 0, 0], "velocity": [0, 7e3, 0]}}' | reentry convert - | jq .geodetic

"#;

const VALIDATE_EXAMPLES: &str = "\
Examples:
  reentry validate
  reentry validate --format json | jq .passed
  reentry validate --format markdown > validation.md

Comparisons with real flights are informational: published data do not determine them fully, so their differences are reported
but never fail.

";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  reentry completions bash > ~/.local/share/bash-completion/completions/reentry
  reentry completions zsh > ~/.zfunc/_reentry
  reentry completions fish > ~/.config/fish/completions/reentry.fish
";

/// Why the program does not end with 0.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A case failed, which has been told.
    #[error("a case failed")]
    Case,
    /// A file cannot be read or written.
    #[error("cannot {act} {path}: {error}")]
    File {
        /// Read or write.
        act: &'static str,
        /// Which.
        path: String,
        /// Why.
        error: io::Error,
    },
    /// A setting is not sound beside the others, or not at all.
    #[error("{0}; see reentry serve --help")]
    Setting(String),
    /// The service cannot run, or does not answer.
    #[error(transparent)]
    Service(#[from] io::Error),
}

impl Cli {
    /// The command line; where it is wrong, says so and ends the program.
    pub fn read() -> Self {
        Self::try_parse().unwrap_or_else(|mut error| {
            // What was given is shown to people.
            let given: Vec<_> = error.context().map(|(kind, value)| (kind, value.clone())).collect();
            for (kind, value) in given {
                let shown = match value {
                    ContextValue::String(text) => ContextValue::String(printable(&text)),
                    ContextValue::Strings(texts) => {
                        ContextValue::Strings(texts.iter().map(|text| printable(text)).collect())
                    }
                    ContextValue::StyledStrs(texts) => {
                        ContextValue::StyledStrs(texts.iter().map(|text| printable(&text.to_string()).into()).collect())
                    }
                    other => other,
                };
                error.insert(kind, shown);
            }
            error.exit()
        })
    }

    /// Does what is asked, but for serving, which is given to `serve`.
    ///
    /// # Errors
    /// With what is to be said, unless it has been, and the code with which to end.
    pub fn run(self, serve: impl FnOnce(Config) -> Result<(), Failure>) -> Result<(), Failure> {
        if !self.lanes {
            use_lanes(LaneInstructions::None);
        }
        if let Some(path) = &self.space_weather {
            use_space_weather(path)?;
        }
        self.command.run(serve)
    }
}

impl Failure {
    /// Says on standard error why the program ends, and with which code.
    pub fn end(&self) -> ExitCode {
        match self {
            Self::Case => {}
            Self::File { .. } | Self::Setting(_) | Self::Service(_) => tell(&[format!("reentry: {self}")]),
        }
        ExitCode::from(match self {
            Self::Case | Self::Service(_) => 1,
            Self::Setting(_) => 2,
            Self::File { .. } => 3,
        })
    }
}

/// Reads the file of space-weather indices, for all cases that ask for it.
///
/// # Errors
/// When it cannot be read, or has no such indices.
fn use_space_weather(path: &Path) -> Result<(), Failure> {
    let text = fs::read_to_string(path).map_err(|error| failure("read", path, error))?;
    let wrong = |error| Failure::Setting(format!("--space-weather {}: {error}", path.display()));
    let records = Records::parse(&text).map_err(wrong)?;
    space_weather::install(records).map_err(|_| wrong("a file is in use already".to_owned()))
}

impl Command {
    fn run(self, serve: impl FnOnce(Config) -> Result<(), Failure>) -> Result<(), Failure> {
        match self {
            Self::Serve(config) => serve(*config),
            Self::Simulate { cases, format } => cases.run(format, answer::simulate),
            Self::Analytic { cases, format } => cases.run(format, answer::analytic),
            Self::Target { cases, .. } => {
                cases.run(Format::Json, |tree, _, _, interrupt| answer::target(tree, None, interrupt))
            }
            Self::Corridor { cases, .. } => {
                cases.run(Format::Json, |tree, _, _, interrupt| answer::corridor(tree, interrupt))
            }
            Self::Footprint { cases, format } => {
                cases.run(format, |tree, format, _, interrupt| answer::footprint(tree, format, None, interrupt))
            }
            Self::Convert { states, .. } => {
                states.run(Format::Json, |tree, _, _, interrupt| answer::convert(tree, interrupt))
            }
            Self::Validate(validate) => validate.run(),
            Self::Healthcheck(healthcheck) => {
                healthcheck.run()?;
                print(b"ok\n")
            }
            Self::Planets => {
                let planets = Planets::all().and_then(|planets| serde_json::to_string_pretty(&planets));
                print(format!("{}\n", planets.map_err(io::Error::from)?).as_bytes())
            }
            Self::Licences(licences) => licences.run(),
            Self::Openapi => print(format!("{:#}\n", document()).as_bytes()),
            Self::Completions { shell } => {
                let mut script = Vec::new();
                clap_complete::generate(shell, &mut Cli::command(), "reentry", &mut script);
                print(&script)
            }
        }
    }
}

fn failure(act: &'static str, path: &Path, error: io::Error) -> Failure {
    Failure::File { act, path: path.display().to_string(), error }
}

/// Writes lines on standard error, as a person may safely read them; where nobody does, nobody is to be told.
fn tell(lines: &[String]) {
    let text: String = lines.iter().map(|line| printable(line) + "\n").collect();
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Writes a result of one piece on standard output.
fn print(bytes: &[u8]) -> Result<(), Failure> {
    Output::new(None).write(bytes).map(drop)
}
