//! Renders the chapters of the guide, Markdown in `guide`, to the pages of `/guide`, `/problems` and `/warnings`.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::{fs, mem};

use flate2::Compression;
use flate2::write::GzEncoder;
use pulldown_cmark::{CodeBlockKind, CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use pulldown_latex::config::{DisplayMode, RenderConfig};
use serde_json::{Value, json};

/// What the pages are made of.
pub(crate) const SOURCES: [&str; 3] = ["guide", "ui/src/tokens.css", "ui/src/icon.svg"];
/// The table of contents: its headings and lists are the navigation of every page, in this order.
const CONTENTS: &str = "index";
/// Chapters of which every section answers at a path of its own, and the member that holds the section's name in JSON.
const SPLIT: [(&str, &str); 2] = [("problems", "type"), ("warnings", "code")];

/// A chapter.
struct Chapter {
    /// The name of its file, and the last part of its path.
    name: String,
    title: String,
    /// The first has the title of the chapter as its heading.
    sections: Vec<Section>,
}

/// A heading of the first or second rank, with what follows it up to the next.
#[derive(Default)]
struct Section {
    id: String,
    heading: String,
    html: String,
    /// Its paragraphs without marks.
    text: String,
}

/// Writes all files of the guide below a folder, and gives their paths.
pub(crate) fn write(root: &Path) -> io::Result<Vec<PathBuf>> {
    let chapters = chapters()?;
    let shell = fs::read_to_string("guide/page.html")?.replace("{navigation}", &navigation()?);
    let page = |title: &str, content: &str| shell.replace("{title}", title).replace("{content}", content).into_bytes();
    let mut files = vec![
        ("guide/guide.css".into(), [fs::read("ui/src/tokens.css")?, fs::read("guide/guide.css")?].concat()),
        ("guide/guide.js".into(), fs::read("guide/guide.js")?),
        ("guide/icon.svg".into(), fs::read("ui/src/icon.svg")?),
        ("guide/search.json".into(), index(&chapters).to_string().into_bytes()),
    ];
    for (at, chapter) in chapters.iter().enumerate() {
        let content: String = chapter.sections.iter().map(|section| section.html.as_str()).collect();
        let neighbours = [at.checked_sub(1), Some(at + 1)].map(|at| at.and_then(|at| chapters.get(at)));
        let content = format!("{content}{}", turn_over(neighbours));
        files.push((format!("guide/{}.html", chapter.name), page(&chapter.title, &content)));
    }
    for (name, member) in SPLIT {
        let chapter = chapters.iter().find(|chapter| chapter.name == name);
        let chapter = chapter.ok_or_else(|| io::Error::other(format!("the guide has no chapter {name}")))?;
        for section in chapter.sections.iter().filter(|section| section.html.starts_with("<h2")) {
            // A page has a heading of the first rank.
            let content = section.html.replace("<h2", "<h1").replace("</h2>", "</h1>");
            let content = format!(r#"{content}<p><a href="../guide/{name}">All {name}</a></p>"#);
            files.push((format!("{name}/{}.html", section.id), page(&section.heading, &content)));
            let value = if member == "type" { format!("/problems/{}", section.id) } else { section.id.clone() };
            let document = json!({member: value, "title": section.heading, "description": section.text.trim(),
                "guide": format!("/guide/{name}#{}", section.id)});
            files.push((format!("{name}/{}.json", section.id), document.to_string().into_bytes()));
        }
    }
    files.into_iter().map(|(path, bytes)| write_file(&root.join(path), &bytes)).collect()
}

/// Writes a file, and the same by gzip beside it.
fn write_file(path: &Path, bytes: &[u8]) -> io::Result<PathBuf> {
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    fs::write(path, bytes)?;
    let mut gzip = GzEncoder::new(fs::File::create(format!("{}.gz", path.display()))?, Compression::best());
    gzip.write_all(bytes)?;
    gzip.finish()?;
    Ok(path.to_owned())
}

/// The contents, and the chapters in their order; a chapter that they do not name, or a name without a chapter, is an error.
fn chapters() -> io::Result<Vec<Chapter>> {
    let contents = fs::read_to_string(format!("guide/{CONTENTS}.md"))?;
    let mut names = vec![CONTENTS.to_owned()];
    for event in parser(&contents) {
        if let Event::Start(Tag::Link { dest_url, .. }) = event
            && let Some(name) = dest_url.strip_suffix(".md")
        {
            names.push(name.to_owned());
        }
    }
    for file in fs::read_dir("guide")? {
        let path = file?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if path.extension().is_some_and(|end| end == "md") && !names.iter().any(|known| *known == name) {
            return Err(io::Error::other(format!("guide/{CONTENTS}.md does not name {name}.md")));
        }
    }
    names.into_iter().map(chapter).collect()
}

/// The headings of the contents, each with links to its chapters.
fn navigation() -> io::Result<String> {
    let contents = fs::read_to_string(format!("guide/{CONTENTS}.md"))?;
    let mut events = Vec::new();
    let mut is_kept = false;
    for event in parser(&contents) {
        let is_end = matches!(event, Event::End(TagEnd::Heading(_) | TagEnd::Link));
        let event = match event {
            Event::Start(Tag::Heading { level: HeadingLevel::H2, .. }) => Event::Html("<p>".into()),
            Event::End(TagEnd::Heading(HeadingLevel::H2)) => Event::Html("</p>".into()),
            Event::Start(Tag::Link { link_type, dest_url, title, id }) if dest_url.ends_with(".md") => {
                Event::Start(Tag::Link { link_type, dest_url: resolved(&dest_url), title, id })
            }
            event => event,
        };
        is_kept |= matches!(event, Event::Html(_) | Event::Start(Tag::Link { .. }));
        let is_list =
            matches!(event, Event::Start(Tag::List(_) | Tag::Item) | Event::End(TagEnd::List(_) | TagEnd::Item));
        if is_kept || is_list {
            events.push(event);
        }
        is_kept &= !is_end;
    }
    let mut written = String::new();
    html::push_html(&mut written, events.into_iter());
    Ok(written)
}

fn chapter(name: String) -> io::Result<Chapter> {
    let path = format!("guide/{name}.md");
    let of_file = |error: &dyn std::fmt::Display| io::Error::other(format!("{path}: {error}"));
    let source = fs::read_to_string(&path).map_err(|error| of_file(&error))?;
    let sections = sections(&source).map_err(|error| of_file(&error))?;
    let title = sections.first().map(|first| first.heading.clone()).filter(|title| !title.is_empty());
    let title = title.ok_or_else(|| of_file(&"a chapter begins with its title"))?;
    Ok(Chapter { name, title, sections })
}

fn parser(source: &str) -> Parser<'_> {
    Parser::new_ext(source, Options::ENABLE_TABLES | Options::ENABLE_HEADING_ATTRIBUTES | Options::ENABLE_MATH)
}

/// The sections of a chapter.
fn sections(source: &str) -> Result<Vec<Section>, String> {
    let mut renderer = Renderer::default();
    for event in parser(source) {
        renderer.note_words(&event);
        renderer.take(event)?;
    }
    renderer.finish_section();
    Ok(renderer.sections)
}

/// What is known of a chapter while its events come.
#[derive(Default)]
struct Renderer<'a> {
    sections: Vec<Section>,
    /// Those of the section that is open, not yet written.
    events: Vec<Event<'a>>,
    /// The text of the section that is open.
    words: String,
    /// The heading that is open, if one is: where its events and its words begin, and its id.
    heading: Option<(usize, usize, Option<String>)>,
    ids: HashSet<String>,
}

impl<'a> Renderer<'a> {
    /// Notes the text of an event.
    fn note_words(&mut self, event: &Event) {
        match event {
            Event::Text(text) | Event::Code(text) | Event::InlineMath(text) | Event::DisplayMath(text) => {
                self.words += text;
            }
            Event::SoftBreak | Event::HardBreak | Event::End(TagEnd::TableCell) => self.words.push(' '),
            Event::End(TagEnd::Item | TagEnd::TableRow | TagEnd::TableHead | TagEnd::CodeBlock) => {
                self.words.push('\n');
            }
            Event::End(TagEnd::Paragraph | TagEnd::List(_)) => self.words += "\n\n",
            _ => {}
        }
    }

    fn take(&mut self, event: Event<'a>) -> Result<(), String> {
        match event {
            Event::Start(Tag::Heading { level, id, .. }) => {
                if level <= HeadingLevel::H2 {
                    self.finish_section();
                    self.sections.push(Section::default());
                }
                self.heading = Some((self.events.len(), self.words.len(), id.map(|id| id.to_string())));
            }
            Event::End(TagEnd::Heading(level)) => self.finish_heading(level)?,
            Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                self.events.push(Event::Start(Tag::Link { link_type, dest_url: resolved(&dest_url), title, id }));
            }
            Event::InlineMath(formula) => self.events.push(Event::InlineHtml(mathml(&formula, DisplayMode::Inline)?)),
            Event::DisplayMath(formula) => self.events.push(Event::InlineHtml(mathml(&formula, DisplayMode::Block)?)),
            // What may be wider than the page scrolls by itself, by the keyboard too.
            Event::Start(Tag::CodeBlock(kind)) => {
                let info = if let CodeBlockKind::Fenced(info) = &kind { info } else { "" };
                let language = info.split(' ').next().unwrap_or_default();
                self.push_html(format!("<pre tabindex=\"0\"><code class=\"language-{language}\">"));
            }
            Event::End(TagEnd::CodeBlock) => self.push_html("</code></pre>\n".to_owned()),
            Event::Start(Tag::Table(_)) => {
                self.push_html("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table\">".to_owned());
                self.events.push(event);
            }
            Event::End(TagEnd::Table) => {
                self.events.push(event);
                self.push_html("</div>\n".to_owned());
            }
            Event::Html(_) | Event::InlineHtml(_) => return Err("HTML is not for the guide".to_owned()),
            event => self.events.push(event),
        }
        Ok(())
    }

    fn push_html(&mut self, html: String) {
        self.events.push(Event::Html(html.into()));
    }

    /// Writes a heading with its id and a link to itself.
    fn finish_heading(&mut self, level: HeadingLevel) -> Result<(), String> {
        let (of_events, of_words, id) = self.heading.take().unwrap_or_default();
        let text = self.words.split_off(of_words);
        let id = id.unwrap_or_else(|| slug(&text));
        if !self.ids.insert(id.clone()) {
            return Err(format!("there are two headings {id}"));
        }
        let mut inner = String::new();
        html::push_html(&mut inner, self.events.split_off(of_events).into_iter());
        let here = format!("<a class=\"here\" href=\"#{id}\" aria-label=\"Link to this section\">#</a>");
        self.push_html(format!("<{level} id=\"{id}\">{inner}{here}</{level}>\n"));
        match self.sections.last_mut() {
            Some(section) if level <= HeadingLevel::H2 => (section.id, section.heading) = (id, text),
            _ => self.words.extend([text.as_str(), "\n"]),
        }
        Ok(())
    }

    /// Writes the section that is open.
    fn finish_section(&mut self) {
        let (events, words) = (mem::take(&mut self.events), mem::take(&mut self.words));
        if let Some(section) = self.sections.last_mut() {
            section.text = words;
            html::push_html(&mut section.html, events.into_iter());
        }
    }
}

/// A link to another chapter, or to another page of the service, from a page one folder below the root.
fn resolved<'a>(link: &str) -> CowStr<'a> {
    let (path, fragment) = link.split_once('#').map_or((link, String::new()), |(path, id)| (path, format!("#{id}")));
    match (path.strip_suffix(".md"), path.strip_prefix('/')) {
        (Some(CONTENTS), _) => format!("../guide/{fragment}"),
        (Some(name), _) => format!("../guide/{name}{fragment}"),
        (None, Some(rest)) => format!("../{rest}{fragment}"),
        (None, None) => link.to_owned(),
    }
    .into()
}

/// The id of a heading that gives none.
fn slug(heading: &str) -> String {
    let words = heading.split(|char: char| !char.is_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect::<Vec<_>>().join("-")
}

/// A formula of LaTeX in `MathML`.
fn mathml<'a>(formula: &str, display_mode: DisplayMode) -> Result<CowStr<'a>, String> {
    let storage = pulldown_latex::Storage::new();
    if let Some(error) = pulldown_latex::Parser::new(formula, &storage).find_map(Result::err) {
        return Err(format!("{formula}: {error}"));
    }
    let mut written = String::new();
    let config = RenderConfig { display_mode, ..RenderConfig::default() };
    pulldown_latex::push_mathml(&mut written, pulldown_latex::Parser::new(formula, &storage), config)
        .map_err(|error| format!("{formula}: {error}"))?;
    Ok(written.into())
}

/// Links to the chapters before and after.
fn turn_over(neighbours: [Option<&Chapter>; 2]) -> String {
    let mut links = String::new();
    for (chapter, rel) in neighbours.into_iter().zip(["prev", "next"]) {
        if let Some(Chapter { name, title, .. }) = chapter {
            let name = if name == CONTENTS { "" } else { name };
            let _ = write!(links, r#"<a rel="{rel}" href="../guide/{name}">{title}</a>"#);
        }
    }
    format!(r#"<nav class="turn" aria-label="Chapters before and after">{links}</nav>"#)
}

/// What the search looks through: every section, with where it stands.
fn index(chapters: &[Chapter]) -> Value {
    let of_chapter = |chapter: &Chapter| {
        let section = |section: &Section| {
            let text = section.text.split_whitespace().collect::<Vec<_>>().join(" ");
            json!({"chapter": chapter.title, "path": format!("{}#{}", chapter.name, section.id), "heading": section.heading, "text": text})
        };
        chapter.sections.iter().map(section).collect::<Vec<_>>()
    };
    chapters.iter().skip(1).flat_map(of_chapter).collect()
}
