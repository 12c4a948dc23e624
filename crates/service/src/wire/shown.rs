//! What others wrote, in messages for people: shortened, and without what a terminal would obey.

use serde_json::Value;

/// Characters of a value that a message shows.
const MOST_SHOWN: usize = 40;

/// The beginning of a value, for a message.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::String(string) => quoted(string),
        Value::Array(_) => "an array".to_owned(),
        Value::Object(_) => "an object".to_owned(),
        Value::Null | Value::Bool(_) | Value::Number(_) => value.to_string(),
    }
}

/// The beginning of a string, in quotation marks.
pub fn quoted(string: &str) -> String {
    format!("{:?}", shortened(string, MOST_SHOWN))
}

/// The beginning of a text: so many characters at most, and a mark where there are more.
pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// One line for a terminal: what no reader sees, or what moves the cursor, changes colours, or turns the direction of the text, is
/// escaped as Rust writes it.
pub fn printable(line: &str) -> String {
    // These are printed as they are; Rust escapes them within its strings alone.
    const KEPT: [char; 3] = ['"', '\'', '\\'];
    let mut shown = String::with_capacity(line.len());
    for part in line.split_inclusive(KEPT) {
        let plain = part.trim_end_matches(KEPT);
        shown.extend(plain.escape_debug());
        shown.push_str(&part[plain.len()..]);
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::{printable, quoted, shortened};

    #[test]
    fn what_a_terminal_would_obey_is_escaped() {
        let obeyed = ('\0'..'\u{20}').chain('\u{7f}'..'\u{a0}').chain('\u{200b}'..'\u{2010}');
        let turned = ('\u{2028}'..'\u{202f}').chain('\u{2060}'..'\u{2070}').chain([
            '\u{61c}',
            '\u{ad}',
            '\u{feff}',
            '\u{e0001}',
        ]);
        for character in obeyed.chain(turned) {
            for text in [printable(&format!("a{character}b")), quoted(&format!("a{character}b"))] {
                assert!(!text.contains(character) && text.contains("a\\"), "{text:?}");
            }
        }
    }

    #[test]
    fn what_people_write_is_left_as_it_is() {
        for text in ["", "a \"b\" 'c' \\d\\", "größer als 0 °C, e\u{301} नमस्ते 日本 🚀…", "\\\"''"]
        {
            assert_eq!(printable(text), text);
        }
    }

    #[test]
    fn a_text_is_cut_between_characters() {
        assert_eq!(shortened("äöü", 3), "äöü");
        assert_eq!(shortened("äöü", 2), "äö…");
        assert_eq!(quoted(&"\n".repeat(41)), format!("\"{}…\"", "\\n".repeat(40)));
    }
}
