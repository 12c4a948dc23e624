import { execFileSync } from 'node:child_process';
import { beforeAll, expect, it, vi } from 'vitest';
import type { Case } from '../../src/api';
import { asCurl, asJson, asPython, fileName } from '../../src/snippets';

const TREE = {
  name: 'Bob\'s "Ω" \\ case $HOME `x`',
  vehicle: { mass: 1e-7 },
  echo: true,
  verify: false,
  output: { times: [0, 1.5] },
  events: [{ when: { quantity: 'mach' } }],
} as unknown as Case;

beforeAll(() => {
  vi.stubGlobal('document', { baseURI: 'http://localhost:8080/' });
});

it('JSON is the case', () => {
  expect(JSON.parse(asJson(TREE))).toEqual(TREE);
});

it('a shell gives curl the case as it is', () => {
  const script = asCurl(TREE).replace(/^curl /, 'show() { printf \'%s\\n\' "$1" "$5"; }; show ');
  const [address, ...body] = execFileSync('sh', ['-c', script], { encoding: 'utf8' }).split('\n');
  expect(address).toBe('http://localhost:8080/simulate');
  expect(JSON.parse(body.join('\n'))).toEqual(TREE);
});

it('a search is sent to its own path', () => {
  expect(asCurl(TREE, 'target')).toMatch(/^curl 'http:\/\/localhost:8080\/target' /);
});

it('Python reads the case as it is', () => {
  const program = asPython(TREE);
  const literal = program.slice(program.indexOf('case = '), program.indexOf('response ='));
  const written = execFileSync('python3', ['-c', `import json\n${literal}\nprint(json.dumps(case))`], { encoding: 'utf8' });
  expect(JSON.parse(written)).toEqual(TREE);
});

it.each([
  ['TARGET reference case 1', 'TARGET_reference_case_1'],
  ['../../etc/passwd', 'etc_passwd'],
  ['C:\\x|y?.exe', 'C_x_y_.exe'],
  ['Böck 日本 नमस्ते', 'Böck_日本_नमस्ते'],
  ['a\u202Egpj.\u0000exe\n', 'a_gpj._exe'],
  ['...', 'flight'],
  ['🚀', 'flight'],
  ['', 'flight'],
  [undefined, 'flight'],
  [5, '5'],
])('a file of the case %j is called %s', (name, file) => {
  expect(fileName({ name } as unknown as Case)).toBe(file);
});

it('a file has a name of 255 bytes at most, with its ending', () => {
  for (const letter of ['x', 'ü', '日', '𠀀']) {
    const name = fileName({ name: letter.repeat(1000) } as Case);
    expect(new TextEncoder().encode(`${name}.case.json`).length).toBeLessThanOrEqual(255);
    expect(name).toBe(letter.repeat(60));
  }
});
