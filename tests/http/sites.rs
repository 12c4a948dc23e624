//! `GET /sites`, and slugs of sites in cases.

use std::collections::BTreeSet;

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use reentry_tests::service::Service;
use serde_json::{Value, json};

use super::refusal::Steady;
use super::requests::{capsule, with, with_all};
use super::simulate::fly;

async fn get(path: &str) -> (StatusCode, String, String) {
    let answer = Service::new().send(Request::builder().uri(path).body(Body::empty()).unwrap()).await;
    let media_type = answer.headers[header::CONTENT_TYPE].to_str().unwrap().to_owned();
    (answer.status, media_type, String::from_utf8(answer.body.to_vec()).unwrap())
}

async fn listed(query: &str) -> Vec<Value> {
    let (status, media_type, body) = get(&format!("/sites{query}")).await;
    assert_eq!((status, media_type.as_str()), (StatusCode::OK, "application/json"), "{body}");
    serde_json::from_str::<Value>(&body).unwrap()["sites"].as_array().unwrap().clone()
}

#[tokio::test]
async fn every_site_has_a_place_and_says_whence() {
    let sites = listed("").await;
    assert_eq!(sites.len(), 64);
    let slugs: BTreeSet<_> = sites.iter().map(|site| site["slug"].as_str().unwrap()).collect();
    assert_eq!(slugs.len(), sites.len());
    for site in &sites {
        assert!(site["geodetic_latitude"].as_f64().unwrap().abs() <= 90.0, "{site}");
        assert!(site["longitude"].as_f64().unwrap().abs() <= 180.0, "{site}");
        assert!((0.0..3000.0).contains(&site["geodetic_altitude"].as_f64().unwrap()), "{site}");
        assert!(site["source"].as_str().unwrap().len() > 10, "{site}");
        let altitude = site["altitude_source"].as_str().unwrap();
        let is_known = altitude == "estimate" || altitude == "sea level" || altitude.contains("airportsdata");
        assert!(is_known, "{site}");
    }
    // Attribution, as CC BY 4.0 asks for it.
    assert!(
        sites.iter().any(|site| site["source"].as_str().unwrap().contains("J. McDowell, planet4589.org, CC BY 4.0"))
    );
}

#[tokio::test]
async fn sites_are_chosen_by_kind_and_country() {
    let all = listed("").await;
    let mut counted = 0;
    for kind in ["launch", "landing", "recovery"] {
        let some = listed(&format!("?kind={kind}")).await;
        assert!(some.iter().all(|site| site["kind"] == kind) && !some.is_empty());
        counted += some.len();
    }
    assert_eq!(counted, all.len());
    let spanish = listed("?country=es&kind=landing").await;
    let slugs: Vec<_> = spanish.iter().map(|site| site["slug"].as_str().unwrap()).collect();
    assert_eq!(slugs, ["zaragoza", "moron"]);
    assert_eq!(listed("?country=XX").await.len(), 0);
    for query in ["?kind=port", "?kind=launch&kind=landing", "?colour=red", "?format=json&kind=launch&format=csv"] {
        let (status, media_type, body) = get(&format!("/sites{query}")).await;
        assert_eq!(
            (status, media_type.as_str()),
            (StatusCode::BAD_REQUEST, "application/problem+json"),
            "{query}: {body}"
        );
    }
}

#[tokio::test]
async fn tables_and_maps_have_the_same_sites() {
    let sites = listed("?kind=landing").await;
    let (_, media_type, table) = get("/sites?kind=landing&format=csv").await;
    assert!(media_type.starts_with("text/csv"));
    let lines: Vec<_> = table.lines().collect();
    assert_eq!(
        lines[0],
        "slug,name,country,kind,geodetic_latitude,longitude,geodetic_altitude,altitude_source,source,note"
    );
    assert_eq!(lines.len(), sites.len() + 1);
    let (_, media_type, map) = get("/sites?kind=landing&format=geojson").await;
    assert_eq!(media_type, "application/geo+json");
    let map: Value = serde_json::from_str(&map).unwrap();
    for ((site, line), feature) in sites.iter().zip(&lines[1..]).zip(map["features"].as_array().unwrap()) {
        assert_eq!(feature["properties"], *site);
        let place = &feature["geometry"]["coordinates"];
        assert_eq!(*place, json!([site["longitude"], site["geodetic_latitude"], site["geodetic_altitude"]]));
        let start = format!("{},", site["slug"].as_str().unwrap());
        let numbers = format!(",{},{},{},", site["geodetic_latitude"], site["longitude"], site["geodetic_altitude"]);
        assert!(line.starts_with(&start) && line.contains(&numbers.replace(".0,", ",")), "{line} for {site}");
    }
}

#[tokio::test]
async fn a_slug_is_the_place_of_its_site() {
    let case = with(&capsule(), "/angle_unit", json!("deg"));
    let asked = |site: Value| with(&case, "/sensitivities", json!({"of": [{"site": site}], "to": ["/vehicle/mass"]}));
    let by_slug = fly(&asked(json!("kourou"))).await["sensitivities"].clone();
    let by_place =
        fly(&asked(json!({"longitude": -52.7517, "geodetic_latitude": 5.2333}))).await["sensitivities"].clone();
    assert_eq!(by_slug, by_place);

    let steady = Steady::new().await;
    for (site, phrase) in
        [(json!("kouru"), "such as \"kourou\""), (json!(3), "string or an object"), (json!("x"), "GET /sites")]
    {
        steady.refused_at("/simulate", &asked(site), &[("/sensitivities/of/0/site", phrase)]).await;
    }
    let on_mars = with_all(&asked(json!("kourou")), [("/planet", json!({"model": "mars"}))]);
    steady.refused_at("/simulate", &on_mars, &[("/sensitivities/of/0/site", "other than the Earth")]).await;
}
