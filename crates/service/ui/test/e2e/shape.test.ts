import { deflateRawSync } from 'node:zlib';
import { describe, expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';
import { browser, example, figure, type Opened, open, prepare, service } from './browser';

prepare();

/** A case of which a few parts are others. */
function like(parts: object): string {
  return JSON.stringify({ ...example('deorbit'), name: 'strange', ...parts });
}

/** The fragment of a text, whatever it is. */
const fragmentOf = (text: string) => `#case=${deflateRawSync(text).toString('base64url')}`;

/** What no form can show, and what the page says of it. */
const STRANGE: [string, () => string, string][] = [
  ['60 MB of spaces', () => ' '.repeat(60e6), 'it exceeds 1 MiB'],
  ['a name of 60 MB', () => like({ name: 'x'.repeat(60e6) }), 'it exceeds 1 MiB'],
  ['events that are a text', () => like({ events: 'text' }), '/events must be an array, got a string'],
  ['10 000 arrays in each other', () => like({ events: 'HERE' }).replace('"HERE"', '['.repeat(1e4) + ']'.repeat(1e4)), '32 levels deep'],
  ['a type that is an object', () => like({ atmosphere: { type: { toString: 5 } } }), '/atmosphere/type must be a single value'],
  ['a name that is an object', () => like({ name: { toString: 5, valueOf: 5 } }), '/name must be a single value'],
  ['a list', () => '[1, 2]', 'it is not a JSON object'],
  ['a text', () => 'altitude, speed', 'is not valid JSON'],
];

const WITHIN = { timeout: 10_000 };

/** The page still flies: a mass that is typed changes the flight. */
async function flies({ page, complaints }: Opened): Promise<void> {
  const before = await figure(page, 'Time');
  await page.locator('#field\\/vehicle\\/mass').fill('1234');
  await expect.poll(() => figure(page, 'Time'), WITHIN).not.toBe(before);
  expect(await page.locator('.card').count()).toBeGreaterThan(5);
  expect(complaints).toEqual([]);
}

describe.each(STRANGE)('%s', (_, textOf, why) => {
  it('in a link is told, and the page begins with an example', async () => {
    const fragment = fragmentOf(textOf());
    const opened = await open(browser, `${service.address}/${fragment}`);
    await opened.page.getByText('Cannot open the case in this link').filter({ hasText: why }).waitFor();
    await expect.poll(() => new URL(opened.page.url()).hash, WITHIN).not.toBe(fragment);
    await flies(opened);
    await opened.page.close();
  });

  it('in a link that is followed on the page, or in a file, is told, and the case stays', async () => {
    const opened = await open(browser, `${service.address}/${await toFragment(example('target_2'))}`);
    const { page } = opened;
    await page.evaluate((fragment) => {
      location.hash = fragment;
    }, fragmentOf(textOf()));
    await page.getByText(why).waitFor();
    // The address is that of the case again.
    await expect.poll(() => fromFragment(new URL(page.url()).hash).catch(() => null), WITHIN).toEqual(example('target_2'));
    await page.getByRole('button', { name: 'Dismiss' }).click();
    const buffer = Buffer.from(textOf().slice(0, 2e6));
    await page.locator('#file').setInputFiles({ name: 'case.json', mimeType: 'application/json', buffer });
    await page.getByText('case.json is not a valid case').waitFor();
    expect(await page.locator('#field\\/vehicle\\/mass').inputValue()).toBe('700');
    await flies(opened);
    await page.close();
  });
});

it('what no form can show is passed over among the cases of earlier visits', async () => {
  const opened = await open(browser, service.address);
  const { page } = opened;
  const sound = JSON.stringify({ id: 1, at: 1, case: example('target_1') });
  const strange = STRANGE.map(([, textOf]) => textOf()).filter((text) => text.length < 1e5 && text.startsWith('{'));
  const entries = [sound, '5', `{"id": {}, "at": [], "case": ${JSON.stringify(example('target_2'))}}`];
  for (const text of strange) entries.push(`{"id": 2, "at": 2, "case": ${text}}`);
  await page.evaluate((text) => localStorage.setItem('recent', text), `[${entries.join()}]`);
  await page.reload();
  await page.locator('[data-figure="Time"]').waitFor();
  expect(strange.length).toBeGreaterThan(3);
  expect(await page.locator('optgroup[label="Recent"] option').count()).toBe(1);
  await flies(opened);
  await page.close();
});

it.each(['initial_state', 'atmosphere', 'wind', 'aerodynamics'])(
  'an unknown type of %s is shown with what the service says',
  async (part) => {
    const opened = await open(browser, service.address);
    const { page } = opened;
    const { vehicle } = example('deorbit');
    for (const type of ['venus', '__proto__', 'constructor', 'toString']) {
      const text = like(part === 'aerodynamics' ? { vehicle: { ...vehicle, aerodynamics: { type } } } : { [part]: { type } });
      await page.goto(`${service.address}/${fragmentOf(text)}`);
      const pointer = part === 'aerodynamics' ? '/vehicle/aerodynamics/type' : `/${part}/type`;
      const fault = page.getByRole('alert').getByRole('listitem').filter({ hasText: pointer }).filter({ hasText: type });
      await fault.waitFor();
      // The field is there to choose another.
      await fault.getByRole('button').click();
      expect(await page.evaluate(() => document.activeElement?.id)).toBe(`field${pointer}`);
    }
    await page.getByLabel('Open', { exact: true }).selectOption({ index: 2 });
    await expect.poll(() => page.getByRole('alert').count(), WITHIN).toBe(0);
    await flies(opened);
    await page.close();
  },
);

it('of thousands of events a hundred are shown, and the page answers meanwhile', async () => {
  const opened = await open(browser, service.address);
  const { page } = opened;
  const text = JSON.stringify({ ...example('target_2'), events: Array(100_000).fill({}) });
  await page.goto(`${service.address}/${fragmentOf(text)}`);
  await page.getByText('/events').first().waitFor();
  expect(await page.locator('.list-item').count()).toBe(100);
  await page.locator('summary', { hasText: 'Events' }).click();
  await page.getByRole('button', { name: 'Show more' }).click();
  expect(await page.locator('.list-item').count()).toBe(200);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect.poll(() => page.getByRole('alert').count(), WITHIN).toBe(0);
  await flies(opened);
  await page.close();
});

it('a case that the service refuses is opened from a link', async () => {
  const opened = await open(browser, service.address);
  const { page } = opened;
  const tree = { ...example('target_2'), density_factor: 'thin', epoch: '+275760-09-13T00:00:00Z' } as unknown as Case;
  await page.goto(`${service.address}/${await toFragment(tree)}`);
  await page.getByText('/density_factor').waitFor();
  expect(await page.locator('#field\\/density_factor').inputValue()).toBe('thin');
  expect(opened.complaints).toEqual([]);
  await page.close();
});
