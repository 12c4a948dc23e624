//! The atmosphere of a request.

use reentry::atmosphere::Atmosphere as CoreAtmosphere;
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::reader::Object;

/// The atmosphere, which turns with the planet.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(("exponential" = "#/components/schemas/ExponentialAtmosphere"))))]
pub enum Atmosphere {
    /// One scale height.
    Exponential(ExponentialAtmosphere),
}

/// Density ρ₀ e^(-h/H) at the altitude h along the radius vector.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ExponentialAtmosphere {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// ρ₀, at altitude 0, kg/m³.
    #[schema(required = false, minimum = 0, default = 1.54793)]
    pub surface_density: f64,
    /// H, m.
    #[schema(required = false, exclusive_minimum = 0, default = 6935)]
    pub scale_height: f64,
}

impl Atmosphere {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        object.choice("type", &[("exponential", ())])?;
        let CoreAtmosphere::Exponential { surface_density, scale_height } = CoreAtmosphere::EARTH_JAMESON;
        let surface_density = object.number_or("surface_density", Bound::NON_NEGATIVE, surface_density);
        let scale_height = object.number_or("scale_height", Bound::POSITIVE, scale_height);
        Some(Self::Exponential(ExponentialAtmosphere {
            kind: "exponential",
            surface_density: surface_density?,
            scale_height: scale_height?,
        }))
    }

    pub(super) fn to_core(self) -> CoreAtmosphere {
        let Self::Exponential(ExponentialAtmosphere { surface_density, scale_height, .. }) = self;
        CoreAtmosphere::Exponential { surface_density, scale_height }
    }

    /// Its `type`.
    pub fn kind(self) -> &'static str {
        let Self::Exponential(exponential) = self;
        exponential.kind
    }
}
