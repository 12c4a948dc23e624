import { describe, expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';
import { ask, browser, example, figure, type Opened, open, prepare, service } from './browser';

prepare();

const LAUNCHER = example('launcher');

/** Opens the page on a case. */
async function on(tree: Case): Promise<Opened> {
  return open(browser, `${service.address}/${await toFragment(tree)}`);
}

const caseOf = async ({ page }: Opened) => (await fromFragment(new URL(page.url()).hash)) as Case;

describe('a case with parts', () => {
  it('keeps every field where another changes, and flies', async () => {
    const opened = await on(LAUNCHER);
    const { page, complaints } = opened;
    await page.locator('#field\\/vehicle\\/parts\\/1\\/propellant').fill('2000');
    const parts = LAUNCHER.vehicle.parts?.map((part, index) => (index === 1 ? { ...part, propellant: 2000 } : part));
    await expect.poll(() => caseOf(opened)).toEqual({ ...LAUNCHER, vehicle: { ...LAUNCHER.vehicle, parts } });
    await page.locator('#field\\/vehicle\\/parts\\/1\\/propellant').fill(String(LAUNCHER.vehicle.parts?.[1]?.propellant));
    await expect.poll(() => caseOf(opened)).toEqual(LAUNCHER);
    // A mass in place of the parts, and back.
    const choice = page.getByLabel('Mass or Parts');
    await choice.selectOption('mass');
    await expect.poll(async () => (await caseOf(opened)).vehicle.parts).toBeUndefined();
    await choice.selectOption('parts');
    await expect.poll(() => caseOf(opened)).toEqual(LAUNCHER);
    expect(complaints).toEqual([]);
    await page.close();
  });

  it('has its events in words, and what has no fields as JSON', async () => {
    const opened = await on(LAUNCHER);
    const { page } = opened;
    await page.locator('summary', { hasText: /^Events/ }).click();
    const staging = page.locator('details.list-item', { hasText: 'staging' }).first();
    expect(await staging.locator('summary').first().textContent()).toContain('separates first stage');
    await staging.locator('summary').first().click();
    await staging.locator('summary', { hasText: 'Separate (JSON)' }).click();
    const text = staging.getByLabel('Separate (JSON) as JSON');
    const before = await text.inputValue();
    await text.fill('[{');
    await staging.getByText('Not valid JSON').waitFor();
    expect(await caseOf(opened)).toEqual(LAUNCHER);
    await text.fill(before.replace('first stage', 'lower stage'));
    await page.getByRole('table').getByText('lower stage').waitFor();
    await page.close();
  });
});

describe('bodies', () => {
  it('are listed as the API tells them, and have a colour on the map and in the plots', async () => {
    const { page, complaints } = await on(LAUNCHER);
    const { bodies } = await ask(service.address, 'simulate', LAUNCHER);
    const table = page.getByRole('region', { name: 'Separated bodies', exact: true });
    const rows = await table.locator('tbody tr').allTextContents();
    expect(rows).toHaveLength(bodies.length);
    for (const [index, body] of bodies.entries()) {
      expect(rows[index]).toContain(body.name);
      expect(rows[index]).toContain(body.separated_by);
      expect(rows[index]).toContain('Impact');
      expect(rows[index]).toContain(`${body.final_state.geodetic_latitude.toFixed(5)}°`);
    }
    const legend = page.getByRole('list', { name: 'Tracks' });
    expect(await legend.getByRole('listitem').allTextContents()).toEqual(['Vehicle', ...bodies.map(({ name }: { name: string }) => name)]);
    // At the end of the slider the vehicle is in orbit, and the last body has come down.
    const time = page.getByLabel('Time', { exact: true });
    await time.fill('1000');
    await page.getByText('vehicle: ended').waitFor();
    const last = Math.max(...bodies.map((body: { final_state: { time: number } }) => body.final_state.time));
    expect(Number.parseFloat((await time.getAttribute('aria-valuetext')) ?? '')).toBeCloseTo(last, -1);
    await page.getByRole('button', { name: 'Zoom to bodies' }).click();
    expect(complaints).toEqual([]);
    await page.close();
  });

  it('fit a narrow screen', async () => {
    const { page } = await open(browser, `${service.address}/${await toFragment(LAUNCHER)}`, { viewport: { width: 390, height: 844 } });
    const isWide = () => page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
    await page.getByRole('region', { name: 'Separated bodies', exact: true }).waitFor();
    expect(await isWide()).toBe(false);
    await page.getByRole('button', { name: 'Case', exact: true }).click();
    await page.locator('summary', { hasText: /^Events/ }).click();
    for (const fold of await page.locator('details.list-item > summary').all()) await fold.click();
    expect(await isWide()).toBe(false);
    await page.close();
  });
});

describe('a launch', () => {
  it('takes the place of a state, which comes back', async () => {
    const capsule = example('lifting_capsule');
    const opened = await on(capsule);
    const { page } = opened;
    const kind = page.getByLabel('Coordinates');
    await kind.selectOption('launch');
    await expect.poll(async () => (await caseOf(opened)).initial_state).toEqual({ type: 'launch', site: 'ksc_lc39a', azimuth: 90 });
    await page.getByLabel('Search sites').fill('zealand');
    const site = page.locator('#field\\/initial_state\\/site');
    await expect.poll(() => site.locator('optgroup option').count()).toBe(1);
    await site.selectOption('mahia');
    await page.getByLabel('Hold down').uncheck();
    await expect
      .poll(async () => (await caseOf(opened)).initial_state)
      .toEqual({ type: 'launch', site: 'mahia', azimuth: 90, hold_down: false });
    await page.getByLabel('Launch from').selectOption('place');
    await expect.poll(async () => (await caseOf(opened)).initial_state).toMatchObject({ geodetic_latitude: -39.2609, hold_down: false });
    await kind.selectOption(capsule.initial_state.type);
    await expect.poll(async () => (await caseOf(opened)).initial_state).toEqual(capsule.initial_state);
    await page.close();
  });

  it('begins at the site or the place that is clicked on the map', async () => {
    const opened = await on(LAUNCHER);
    const { page } = opened;
    const { sites } = await (await fetch(`${service.address}/sites`)).json();
    const map = page.locator('canvas.world');
    await map.scrollIntoViewIfNeeded();
    const { width, height } = (await map.boundingBox()) as { width: number; height: number };
    const position = (longitude: number, latitude: number) => ({
      x: ((longitude + 180) / 360) * width,
      y: ((90 - latitude) / 180) * height,
    });
    const kourou = sites.find(({ slug }: { slug: string }) => slug === 'kourou');
    const there = position(kourou.longitude, kourou.geodetic_latitude);
    await map.hover({ position: there });
    await page.locator('.site-name', { hasText: 'French Guiana' }).waitFor();
    // Elsewhere a click does nothing unless a place is to be picked.
    await map.click({ position: position(-120, -30) });
    await map.click({ position: there });
    await expect.poll(async () => (await caseOf(opened)).initial_state).toEqual({ ...LAUNCHER.initial_state, site: 'kourou' });
    await page.getByRole('button', { name: 'Pick launch place' }).click();
    await map.click({ position: position(-120, -30) });
    const { site: _, ...others } = LAUNCHER.initial_state as { site: string };
    await expect
      .poll(async () => (await caseOf(opened)).initial_state)
      .toEqual({ ...others, longitude: expect.any(Number), geodetic_latitude: expect.any(Number) });
    const place = (await caseOf(opened)).initial_state as { longitude: number; geodetic_latitude: number };
    expect(place.longitude).toBeCloseTo(-120, -1);
    expect(place.geodetic_latitude).toBeCloseTo(-30, -1);
    await page.close();
  });

  it('has a slider for its azimuth', async () => {
    const { page } = await on(LAUNCHER);
    const before = await figure(page, 'Final position');
    await page.locator('#slider-initial_state-azimuth').fill('900');
    await expect.poll(() => figure(page, 'Final position')).not.toBe(before);
    await page.close();
  });
});
