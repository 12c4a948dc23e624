//! The heating that a request asks for.

use reentry::heating::{Convective, Heating as CoreHeating, Radiative};
use reentry::scenario::Bound;

use super::description::{Object, WordOrObject, Words, word};

/// The heating of a request.
#[derive(Clone, Debug)]
pub struct Heating {
    /// The correlations and the emissivity.
    pub core: CoreHeating,
    /// Whether the convective flux is that in air, and not that in a gas with a constant of its own.
    convective_in_air: bool,
}

impl Heating {
    /// The correlations that are those of air.
    pub(super) fn of_air(&self) -> Vec<&'static str> {
        let convective = self.convective_in_air.then(|| CONVECTIVE.of((self.core.convective, true)));
        let radiative = (self.core.radiative != Radiative::None).then(|| RADIATIVE.of(self.core.radiative));
        convective.into_iter().chain(radiative).collect()
    }
}

/// Correlations of the convective flux in air, each with the mark that it is in air.
const CONVECTIVE: Words<(Convective, bool)> = Words {
    name: "Convective",
    doc: "Correlation of the convective heat flux in air, W/m², with the density ρ in kg/m³, the air speed V in m/s \
          and the nose radius r in m.",
    words: &[
        word("sutton_graves", (Convective::SUTTON_GRAVES, true), "Sutton–Graves")
            .doc("1.7415e-4 √(ρ/r) V³; NASA TR R-376, for 2.1 to 15.2 km/s."),
        word("detra_kemp_riddell", (Convective::DetraKempRiddell, true), "Detra–Kemp–Riddell")
            .doc("1.1035e8/√r √(ρ/1.225) (V/7924.8)^3.15; Jet Propulsion 27 (1957), up to 8 km/s."),
        word("chapman", (Convective::Chapman, true), "Chapman")
            .doc("1.1035e8/√r √(ρ/1.225) (V/7924.8)³; NASA TR R-11, up to 11.2 km/s."),
    ],
};

/// Correlations of the radiative flux.
const RADIATIVE: Words<Radiative> = Words {
    name: "Radiative",
    doc: "Correlation of the radiative heat flux, W/m², with the nose radius r in m, the density ρ in kg/m³ and the \
          air speed V in m/s.",
    words: &[
        word("none", Radiative::None, "None").doc("No radiative heat flux."),
        word("tauber_sutton", Radiative::TauberSutton, "Tauber–Sutton").doc(
            "4.736e8 r^a ρ^1.22 f(V), with f tabulated from 9 to 16 km/s and zero below; J. Spacecraft 28 (1991), for \
             10 to 16 km/s, nose radii of 0.3 to 3 m and densities of 6.66e-5 to 6.31e-4 kg/m³.",
        ),
    ],
};

/// A correlation in air by its name, or that of Sutton and Graves in another gas.
const CONVECTIVE_FLUX: WordOrObject = WordOrObject {
    name: "ConvectiveFlux",
    doc: "Convective heat flux: a correlation for air, or that of Sutton and Graves for another gas.",
};

/// The heating.
pub(super) fn heating(object: &mut Object) -> Option<Heating> {
    object.named(
        "Heating",
        "Heating of the stagnation point: heat fluxes into a cold wall, their integral, and the radiative equilibrium \
         temperature of the wall. The vehicle must have a `nose_radius`.",
    );
    let default = CoreHeating::default();
    let convective = object
        .field("convective", "Convective heat flux")
        .doc(
            "Convective heat flux: the name of a correlation for air, or that of Sutton and Graves with the constant \
             of another gas.",
        )
        .default(CONVECTIVE.of((default.convective, true)))
        .word_or(&CONVECTIVE_FLUX, &CONVECTIVE, sutton_graves);
    let radiative = object
        .field("radiative", "Radiative heat flux")
        .doc("Radiative heat flux from the shocked air.")
        .default(RADIATIVE.of(default.radiative))
        .word(&RADIATIVE);
    let emissivity = object
        .field("emissivity", "Wall emissivity")
        .doc("Emissivity of the wall, greater than 0 and at most 1.")
        .default(default.emissivity)
        .number(Bound::EMISSIVITY);
    let (convective, convective_in_air) = convective?;
    let core = CoreHeating { convective, radiative: radiative?, emissivity: emissivity? };
    Some(Heating { core, convective_in_air })
}

fn sutton_graves(object: &mut Object) -> Option<(Convective, bool)> {
    object.named("SuttonGraves", "Correlation of Sutton and Graves for a given gas: k √(ρ/r) V³.");
    object.field("type", "Type").doc("Always `sutton_graves`.").constant("sutton_graves");
    let constant = object
        .field("constant", "Sutton–Graves constant")
        .doc("Constant k, kg^0.5/m; 1.7415e-4 for air. NASA TR R-376 lists other gases.")
        .unit("√kg/m")
        .number(Bound::POSITIVE);
    Some((Convective::SuttonGraves { constant: constant? }, false))
}
