//! Writes the table of the bodies in `bodies`, one file each, by which they are compiled into the library.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use serde_json::Value;

/// The columns of an atmosphere.
const COLUMNS: [&str; 6] = ["altitude", "density", "temperature", "pressure", "molar_mass", "heat_capacity_ratio"];

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=bodies");
    let mut files = fs::read_dir("bodies")?.map(|file| Ok(file?.path())).collect::<io::Result<Vec<PathBuf>>>()?;
    files.sort();
    let entries = files.iter().map(|file| entry(file)).collect::<io::Result<String>>()?;
    let out = Path::new(&env::var("OUT_DIR").map_err(io::Error::other)?).join("bodies.rs");
    fs::write(out, format!("&[\n{entries}]"))
}

/// A list of numbers.
fn numbers(list: &Value) -> Option<Vec<f64>> {
    list.as_array()?.iter().map(Value::as_f64).collect()
}

/// A list of three numbers each.
fn rows(list: &Value) -> Option<Vec<[f64; 3]>> {
    list.as_array()?.iter().map(|row| numbers(row)?.try_into().ok()).collect()
}

/// The entry of a body.
fn entry(file: &Path) -> io::Result<String> {
    let wrong = |what: &str| io::Error::other(format!("{}: {what}", file.display()));
    let text = fs::read_to_string(file)?;
    let body: Value = serde_json::from_str(&text)?;
    let number = |pointer: &str| body.pointer(pointer).and_then(Value::as_f64).ok_or_else(|| wrong(pointer));
    let word = |pointer: &str| body.pointer(pointer).and_then(Value::as_str).ok_or_else(|| wrong(pointer));
    let mut written = String::from("Body {\n");
    let mut member = |name: &str, value: String| {
        let _ = writeln!(written, "    {name}: {value},");
    };
    member("name", format!("{:?}", word("/name")?));
    member("title", format!("{:?}", word("/title")?));
    member("doc", format!("{:?}", word("/description")?));
    for name in ["gravitational_parameter", "equatorial_radius", "polar_radius", "rotation_rate", "prime_meridian"] {
        member(name, format!("{:?}", number(&format!("/{name}/value"))?));
    }
    member("zonal", format!("{:?}", [number("/zonal/j2")?, number("/zonal/j3")?, number("/zonal/j4")?]));
    let terms = body.pointer("/prime_meridian/periodic_terms").map_or(Some(Vec::new()), rows);
    let terms = terms.ok_or_else(|| wrong("/prime_meridian/periodic_terms"))?;
    member("prime_meridian_terms", format!("&{terms:?}"));
    let constant = body.pointer("/sutton_graves_constant/value").and_then(Value::as_f64);
    member("sutton_graves_constant", format!("{constant:?}"));
    let radiation = match body.pointer("/radiation/value").and_then(Value::as_str) {
        None => "Radiative::None",
        Some("tauber_sutton") => "Radiative::TauberSuttonMars",
        Some("craig_lyne") => "Radiative::CraigLyne",
        Some(_) => return Err(wrong("/radiation/value")),
    };
    member("radiation", radiation.to_owned());
    let atmosphere = if body.get("atmosphere").is_some() {
        let mut atmosphere = String::from("Some(BodyAtmosphere { ");
        let mut length = None;
        for column in COLUMNS {
            let numbers = body.pointer(&format!("/atmosphere/{column}")).and_then(numbers);
            let numbers = numbers.ok_or_else(|| wrong(column))?;
            let is_sound = if column == "altitude" {
                numbers.len() >= 2 && numbers.windows(2).all(|pair| pair[0] < pair[1])
            } else {
                numbers.iter().all(|number| *number > 0.0)
            };
            if !is_sound || *length.get_or_insert(numbers.len()) != numbers.len() {
                return Err(wrong(column));
            }
            let _ = write!(atmosphere, "{column}: &{numbers:?}, ");
        }
        let is_low = word("/atmosphere/confidence")? == "low";
        let _ = write!(atmosphere, "source: {:?}, has_low_confidence: {is_low} }})", word("/atmosphere/source")?);
        atmosphere
    } else {
        "None".to_owned()
    };
    member("atmosphere", atmosphere);
    member("source", format!("{text:?}"));
    written.push_str("},\n");
    Ok(written)
}
