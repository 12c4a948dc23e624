// The theme that the page remembers, the search, and a button that copies a block of code.

/** What the page remembers under a name; nothing where the browser keeps nothing. */
function remembered(name) {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}
document.documentElement.dataset.theme = remembered('theme') ?? 'auto';

const input = document.getElementById('search');
const found = document.getElementById('found');
const MOST_FOUND = 20;
let sections;

/** In small letters, with a blank for each mark inside a word, so that delta-v, delta_v and Delta V are the same; of the same length. */
function plain(text) {
  return ` ${text.toLowerCase().replaceAll(/[-_‐–‘’“”"'`(/]/g, ' ')}`;
}

/** Sections that have a word that begins with every given one, those with all in a row or in their heading first. */
function matches(words) {
  const scored = sections.map((section) => {
    const heading = plain(`${section.chapter} ${section.heading}`);
    const text = plain(section.text);
    const scores = words.map((word) => (heading.includes(` ${word}`) ? 10 : text.includes(` ${word}`) ? 1 : -Infinity));
    const phrase = ` ${words.join(' ')}`;
    const together = heading.includes(phrase) ? 20 : text.includes(phrase) ? 5 : 0;
    return { section, score: scores.reduce((sum, score) => sum + score, together) };
  });
  return scored
    .filter(({ score }) => score > 0)
    .sort((a, b) => b.score - a.score)
    .slice(0, MOST_FOUND);
}

/** The words around the first one that was found. */
function around(text, words) {
  const places = words.map((word) => plain(text).indexOf(` ${word}`)).filter((place) => place >= 0);
  const at = Math.max(0, Math.min(...places));
  const from = Number.isFinite(at) ? Math.max(0, text.lastIndexOf(' ', at - 40)) : 0;
  return `${from > 0 ? '… ' : ''}${text.slice(from, from + 140).trim()} …`;
}

async function search() {
  const words = plain(input.value).split(/\s+/).filter(Boolean);
  sections ??= await (await fetch(new URL('search.json', import.meta.url))).json();
  found.hidden = words.length === 0;
  const items = matches(words).map(({ section }) => {
    const item = document.createElement('li');
    const link = document.createElement('a');
    link.href = new URL(section.path, import.meta.url).href;
    link.textContent = section.heading === section.chapter ? section.chapter : `${section.chapter}: ${section.heading}`;
    const excerpt = document.createElement('p');
    excerpt.textContent = around(section.text, words);
    item.append(link, excerpt);
    return item;
  });
  if (items.length === 0)
    items.push(Object.assign(document.createElement('li'), { textContent: 'Nothing found. Try one word, or look into the glossary.' }));
  found.replaceChildren(...items);
}

input.hidden = false;
input.addEventListener('input', () => void search());
addEventListener('keydown', (event) => {
  if (event.key === '/' && !(event.target instanceof HTMLInputElement)) {
    event.preventDefault();
    input.focus();
  }
  if (event.key === 'Escape') {
    input.value = '';
    found.hidden = true;
  }
});
// A link to a section of this page closes the list, too.
found.addEventListener('click', () => {
  found.hidden = true;
});

for (const block of document.querySelectorAll('pre')) {
  const button = Object.assign(document.createElement('button'), { type: 'button', textContent: 'Copy', className: 'copy' });
  button.addEventListener('click', async () => {
    await navigator.clipboard.writeText(block.querySelector('code').textContent);
    button.textContent = 'Copied';
    setTimeout(() => {
      button.textContent = 'Copy';
    }, 1500);
  });
  const frame = Object.assign(document.createElement('div'), { className: 'code' });
  block.replaceWith(frame);
  frame.append(block, button);
}

for (const link of document.querySelectorAll('.chapters a')) {
  if (link.pathname !== location.pathname) continue;
  link.setAttribute('aria-current', 'page');
  // The sections of a long chapter, below its name.
  const headings = [...document.querySelectorAll('main h2')];
  if (headings.length < 3) continue;
  const list = document.createElement('ul');
  for (const heading of headings) {
    const section = Object.assign(document.createElement('a'), { href: `#${heading.id}` });
    section.textContent = heading.textContent.replace(/#$/, '');
    const item = document.createElement('li');
    item.append(section);
    list.append(item);
  }
  link.after(list);
}
