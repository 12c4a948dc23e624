//! The heating that a request asks for.

use reentry::heating::{Convective, Heating as CoreHeating, Radiative};
use reentry::scenario::Bound;

use super::description::{Object, WordOrObject, Words, word};
use super::planet::PlanetModel;

/// The heating of a request.
#[derive(Clone, Debug)]
pub struct Heating {
    /// The correlations and the emissivity.
    pub core: CoreHeating,
    /// The correlations that are those of the Earth's air, by their words.
    of_air: Vec<&'static str>,
}

impl Heating {
    /// The correlations that are those of the Earth's air, by their words.
    pub(super) fn of_air(&self) -> &[&'static str] {
        &self.of_air
    }
}

/// A correlation of the convective flux by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NamedConvective {
    SuttonGraves,
    DetraKempRiddell,
    Chapman,
}

/// The convective flux of a request: by a name, or by Sutton and Graves with a constant.
#[derive(Clone, Copy, Debug)]
enum ConvectiveFlux {
    Named(NamedConvective),
    WithConstant(f64),
}

impl From<NamedConvective> for ConvectiveFlux {
    fn from(named: NamedConvective) -> Self {
        Self::Named(named)
    }
}

/// Correlations of the convective flux.
const CONVECTIVE: Words<NamedConvective> = Words {
    name: "Convective",
    doc: "Correlation of the convective heat flux, W/m², with the density ρ in kg/m³, the air speed V in m/s and the \
          nose radius r in m.",
    words: &[
        word("sutton_graves", NamedConvective::SuttonGraves, "Sutton–Graves").doc(
            "k √(ρ/r) V³, with k = 1.7415e-4 in air, and on a named planet the constant that `GET /planets` lists; \
             NASA TR R-376, for 2.1 to 15.2 km/s.",
        ),
        word("detra_kemp_riddell", NamedConvective::DetraKempRiddell, "Detra–Kemp–Riddell")
            .doc("1.1035e8/√r √(ρ/1.225) (V/7924.8)^3.15, in air; Jet Propulsion 27 (1957), up to 8 km/s."),
        word("chapman", NamedConvective::Chapman, "Chapman")
            .doc("1.1035e8/√r √(ρ/1.225) (V/7924.8)³, in air; NASA TR R-11, up to 11.2 km/s."),
    ],
};

/// A correlation of the radiative flux by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NamedRadiative {
    None,
    TauberSutton,
    CraigLyne,
}

/// Correlations of the radiative flux.
const RADIATIVE: Words<NamedRadiative> = Words {
    name: "Radiative",
    doc: "Correlation of the radiative heat flux, W/m², with the nose radius r in m, the density ρ in kg/m³ and the \
          air speed V in m/s.",
    words: &[
        word("none", NamedRadiative::None, "None").doc("No radiative heat flux."),
        word("tauber_sutton", NamedRadiative::TauberSutton, "Tauber–Sutton").doc(
            "On the Earth 4.736e8 r^a ρ^1.22 f(V), with f tabulated from 9 to 16 km/s and zero below, for 10 to \
             16 km/s, nose radii of 0.3 to 3 m and densities of 6.66e-5 to 6.31e-4 kg/m³; on Mars 2.35e8 r^0.526 \
             ρ^1.19 f(V), with f tabulated from 6 to 9 km/s and zero below, for 6.5 to 9 km/s; J. Spacecraft 28 \
             (1991).",
        ),
        word("craig_lyne", NamedRadiative::CraigLyne, "Craig–Lyne").doc(
            "On Venus C V^n ρ^1.2 r^0.49, with C and n for speeds below 8 km/s, up to 10 km/s and above; J. Spacecraft \
             42 (2005).",
        ),
    ],
};

/// A correlation by its name, or that of Sutton and Graves with a constant.
const CONVECTIVE_FLUX: WordOrObject = WordOrObject {
    name: "ConvectiveFlux",
    doc: "Convective heat flux: a correlation, or that of Sutton and Graves with the constant of a gas.",
};

/// The heating, on a planet, which is not known where the request has a fault about it.
pub(super) fn heating(object: &mut Object, planet: Option<PlanetModel>) -> Option<Heating> {
    object.named(
        "Heating",
        "Heating of the stagnation point: heat fluxes into a cold wall, their integral, and the radiative equilibrium \
         temperature of the wall. The vehicle must have a `nose_radius`.",
    );
    let convective = object
        .field("convective", "Convective heat flux")
        .doc(
            "Convective heat flux: the name of a correlation, or that of Sutton and Graves with the constant of a \
             gas. A correlation that is not for the gas of a named planet is refused; on a custom planet it has the warning \
             `gas_of_earth`.",
        )
        .default(CONVECTIVE.of(NamedConvective::SuttonGraves))
        .word_or(&CONVECTIVE_FLUX, &CONVECTIVE, sutton_graves);
    let radiative = object
        .field("radiative", "Radiative heat flux")
        .doc(
            "Radiative heat flux from the shocked air: on the Earth and on Mars `tauber_sutton`, on Venus \
             `craig_lyne`. Of the other named planets there is no correlation.",
        )
        .default(RADIATIVE.of(NamedRadiative::None))
        .word(&RADIATIVE);
    let emissivity = object
        .field("emissivity", "Wall emissivity")
        .doc("Emissivity of the wall, greater than 0 and at most 1.")
        .default(CoreHeating::default().emissivity)
        .number(Bound::EMISSIVITY);
    let planet = planet?;
    let mut of_air = Vec::new();
    if let (Some(ConvectiveFlux::Named(named)), PlanetModel::Custom) = (convective, planet) {
        of_air.push(CONVECTIVE.of(named));
    }
    if let (Some(named), PlanetModel::Custom) = (radiative.filter(|named| *named != NamedRadiative::None), planet) {
        of_air.push(RADIATIVE.of(named));
    }
    // Both are looked at before either ends the reading, so that all faults are told.
    let convective = convective.map(|convective| convective_in(convective, planet));
    let radiative = radiative.map(|radiative| radiative_in(radiative, planet));
    if let Some(Err(detail)) = &convective {
        object.fault_of("convective", detail.clone());
    }
    if let Some(Err(detail)) = &radiative {
        object.fault_of("radiative", detail.clone());
    }
    let core = CoreHeating { convective: convective?.ok()?, radiative: radiative?.ok()?, emissivity: emissivity? };
    Some(Heating { core, of_air })
}

/// The correlation of the convective flux in the gas of a planet, or why there is none.
fn convective_in(convective: ConvectiveFlux, planet: PlanetModel) -> Result<Convective, String> {
    use NamedConvective::{Chapman, DetraKempRiddell, SuttonGraves};
    let named = match convective {
        ConvectiveFlux::WithConstant(constant) => return Ok(Convective::SuttonGraves { constant }),
        ConvectiveFlux::Named(named) => named,
    };
    let remedy = "give {\"type\": \"sutton_graves\", \"constant\": k} of the gas";
    match (named, planet) {
        (SuttonGraves, PlanetModel::Body(body)) => match body.sutton_graves_constant {
            Some(constant) => Ok(Convective::SuttonGraves { constant }),
            None => {
                Err(format!("must not be \"sutton_graves\" alone: no constant is known for {}; {remedy}", body.title))
            }
        },
        (_, PlanetModel::Body(body)) => {
            let word = CONVECTIVE.of(named);
            Err(format!("must not be {word:?}, a correlation for the Earth's air, on {}; {remedy}", body.title))
        }
        (SuttonGraves, _) => Ok(Convective::SUTTON_GRAVES),
        (DetraKempRiddell, _) => Ok(Convective::DetraKempRiddell),
        (Chapman, _) => Ok(Convective::Chapman),
    }
}

/// The correlation of the radiative flux in the gas of a planet, or why there is none.
fn radiative_in(radiative: NamedRadiative, planet: PlanetModel) -> Result<Radiative, String> {
    let known = match planet {
        PlanetModel::Body(body) => body.radiation,
        // Of another gas with a warning.
        _ => Radiative::TauberSutton,
    };
    let word = match known {
        Radiative::None => None,
        Radiative::TauberSutton | Radiative::TauberSuttonMars => Some(NamedRadiative::TauberSutton),
        Radiative::CraigLyne => Some(NamedRadiative::CraigLyne),
    };
    if radiative == NamedRadiative::None {
        return Ok(Radiative::None);
    }
    if word == Some(radiative) {
        return Ok(known);
    }
    let refused = RADIATIVE.of(radiative);
    let remedy = match word {
        Some(word) => format!("use {:?} or \"none\"", RADIATIVE.of(word)),
        None => "no correlation of the radiative heat flux is known; use \"none\"".to_owned(),
    };
    Err(format!("must not be {refused:?} on {}: {remedy}", planet.title()))
}

fn sutton_graves(object: &mut Object) -> Option<ConvectiveFlux> {
    object.named("SuttonGraves", "Correlation of Sutton and Graves for a given gas: k √(ρ/r) V³.");
    object.field("type", "Type").doc("Always `sutton_graves`.").constant("sutton_graves");
    let constant = object
        .field("constant", "Sutton–Graves constant")
        .doc("Constant k, kg^0.5/m; 1.7415e-4 for air. NASA TR R-376 lists other gases.")
        .unit("√kg/m")
        .number(Bound::POSITIVE);
    constant.map(ConvectiveFlux::WithConstant)
}
