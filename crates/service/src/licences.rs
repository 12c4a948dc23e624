//! The licences of all that the program is made of, as the build collects them.

use std::fmt::Write as _;
use std::io;

use flate2::read::GzDecoder;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// As the build writes them: JSON by gzip, a tenth as long.
static COLLECTED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/licences.json.gz"));

/// Licences of the program and of everything in it.
#[derive(Clone, Debug, Serialize, Deserialize, ToSchema)]
pub struct Licences {
    /// Version of the service.
    pub version: String,
    /// Components of the program, ordered by part and name.
    pub components: Vec<Component>,
    /// Texts of the licences, each once.
    pub texts: Vec<String>,
}

/// Component of the program with its licence.
#[derive(Clone, Debug, Serialize, Deserialize, ToSchema)]
pub struct Component {
    /// Name.
    pub name: String,
    /// Version; null if it has none.
    #[schema(required = true)]
    pub version: Option<String>,
    /// Part of the program.
    pub part: Part,
    /// SPDX licence expression.
    pub licence: String,
    /// Where its source is; null for the program itself.
    #[schema(required = true)]
    pub source: Option<String>,
    /// Its licence and notices: indices in `texts` of the answer, from 0.
    pub texts: Vec<usize>,
}

/// Part of the program. `program`: the program itself. `data`: tables and maps in it. `page`: what the page and the API
/// documents load in a browser. `crate`: Rust libraries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// The program itself.
    Program,
    /// Tables and maps in it.
    Data,
    /// What runs in a browser.
    Page,
    /// Libraries that are linked into it.
    Crate,
}

impl Licences {
    /// Those of this program.
    ///
    /// # Errors
    /// Never: the build has written them.
    pub fn of_program() -> io::Result<Self> {
        Ok(serde_json::from_reader(GzDecoder::new(COLLECTED))?)
    }

    /// As JSON, on one line.
    ///
    /// # Errors
    /// Never: all of it is text and numbers.
    pub fn to_json(&self) -> Result<Vec<u8>, serde_json::Error> {
        serde_json::to_vec(self)
    }

    /// To read in a terminal: the components with the numbers of their texts, then the texts with whose they are.
    pub fn to_text(&self) -> String {
        let mut out =
            format!("reentry {} and what is in it. The numbers are those of the texts below.\n", self.version);
        for (part, heading) in HEADINGS {
            let components: Vec<_> = self.components.iter().filter(|component| component.part == part).collect();
            if !components.is_empty() {
                let _ = write!(out, "\n{heading}\n\n");
            }
            for component in components {
                let numbers: Vec<_> = component.texts.iter().map(|index| format!("[{}]", index + 1)).collect();
                let _ = writeln!(out, "  {}: {} {}", component.title(), component.licence, numbers.join(" "));
                if let Some(source) = &component.source {
                    let _ = writeln!(out, "    {source}");
                }
            }
        }
        for (index, text) in self.texts.iter().enumerate() {
            let _ = write!(out, "\n{}\n[{}]", "-".repeat(WIDTH), index + 1);
            let components = self.components.iter().filter(|component| component.texts.contains(&index));
            push_wrapped(&mut out, &components.map(Component::title).collect::<Vec<_>>());
            let _ = write!(out, "\n\n{text}\n");
        }
        out
    }
}

impl Component {
    fn title(&self) -> String {
        match &self.version {
            Some(version) => format!("{} {version}", self.name),
            None => self.name.clone(),
        }
    }
}

/// The parts in their order, with what stands above them.
const HEADINGS: [(Part, &str); 4] =
    [(Part::Program, "PROGRAM"), (Part::Data, "DATA"), (Part::Page, "PAGE"), (Part::Crate, "CRATES")];

/// Characters of a line.
const WIDTH: usize = 80;

/// Adds a list to the last line of a text, in lines of `WIDTH` at most.
fn push_wrapped(out: &mut String, list: &[String]) {
    let mut length = out.lines().next_back().map_or(0, str::len);
    for (index, element) in list.iter().enumerate() {
        let comma = if index + 1 < list.len() { "," } else { "" };
        length += 1 + element.len() + comma.len();
        if length > WIDTH {
            out.push_str("\n   ");
            length = 4 + element.len() + comma.len();
        }
        let _ = write!(out, " {element}{comma}");
    }
}
