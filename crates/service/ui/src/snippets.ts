import { address, type Case } from './api';

/** A case, or what is asked of it, as JSON. */
export function asJson(tree: object): string {
  return JSON.stringify(tree, null, 2);
}

/** What a file of the case is called, without an ending: its name as every system takes it, which is letters and digits, and 255 bytes at most. */
export function fileName({ name }: Case): string {
  const words = [...String(name ?? '').replaceAll(/[^\p{L}\p{M}\p{N}_.-]+/gu, '_')].slice(0, 60).join('');
  return words.replace(/^[_.-]+/, '').replace(/[_.-]+$/, '') || 'flight';
}

/** A command for a shell that flies the case, or sends what a search asks. */
export function asCurl(tree: object, endpoint = 'simulate'): string {
  return `curl '${address(endpoint)}' -H 'content-type: application/json' -d '${asJson(tree).replaceAll("'", "'\\''")}'\n`;
}

/** A program in Python, with `requests`, that flies the case. */
export function asPython(tree: Case): string {
  return `import requests

case = ${python(tree)}

response = requests.post("${address('simulate')}", json=case)
flight = response.json()
if not response.ok:
    raise SystemExit(flight["detail"])
print(flight["termination"], flight["final_state"])
`;
}

/** A value of JSON as a literal of Python; a string of JSON is one already. */
function python(value: unknown, indent = ''): string {
  const inner = `${indent}    `;
  if (value === true) return 'True';
  if (value === false) return 'False';
  if (value === null || value === undefined) return 'None';
  if (Array.isArray(value)) {
    const isFlat = value.every((item) => typeof item !== 'object');
    if (isFlat) return `[${value.map((item) => python(item)).join(', ')}]`;
    return `[\n${value.map((item) => `${inner}${python(item, inner)},\n`).join('')}${indent}]`;
  }
  if (typeof value === 'object') {
    const items = Object.entries(value).map(([name, item]) => `${inner}${JSON.stringify(name)}: ${python(item, inner)},\n`);
    return `{\n${items.join('')}${indent}}`;
  }
  return JSON.stringify(value);
}
