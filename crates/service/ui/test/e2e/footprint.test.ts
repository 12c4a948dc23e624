import { readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import type { Case, FootprintRequest } from '../../src/api';
import { get } from '../../src/case';
import { fromFragment, toFragment } from '../../src/link';
import { browser, example, figure, open, prepare, service, source } from './browser';

prepare();

const caseOf = async (page: Page) => (await fromFragment(new URL(page.url()).hash)) as Case;
const partOf = (page: Page) => page.getByRole('region', { name: 'Footprint', exact: true });
const said = (page: Page) => partOf(page).getByRole('status').textContent();
/** Waits until it is as exact as it is to be. */
const refined = (page: Page) =>
  expect.poll(() => said(page), { timeout: 60_000 }).toMatch(/^(A curve|[\d,]+ km²), (complete|not complete)/);

/** The case of the example with so many bank angles that are free, and what makes its flights short and quick. */
function banks(free: number, more: object): Case {
  const { limits: _, resolution: __, vary = [], ...flight } = example('footprint') as Case & { resolution?: number };
  const short = {
    atmosphere: { type: 'exponential', surface_density: 1.54793, scale_height: 6935 },
    planet: { model: 'earth_wgs84', shape: 'sphere' },
    control: { bank_angle: { type: 'schedule', against: 'time', at: [0, 30, 40, 2000], value: [40, 40, -40, -40] } },
    initial_state: { ...flight.initial_state, geodetic_altitude: 80_000, flight_path_angle: -6 },
    stop: { altitude: 10_000 },
    solver: { relative_tolerance: 1e-3 },
  };
  return { ...flight, ...short, vary: vary.slice(0, free), ...more } as Case;
}
const COARSE = { resolution: 5e4 };
/** Two numbers take a thousand flights at least. */
const PATIENCE = 180_000;

/** How many pixels of the map have the colour of the edge. */
function pixelsOfEdge(page: Page): Promise<number> {
  return page.locator('canvas.world').evaluate((canvas: HTMLCanvasElement) => {
    const { data } = (canvas.getContext('2d') as CanvasRenderingContext2D).getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let at = 0; at < data.length; at += 4)
      if (Math.hypot((data[at] ?? 0) - 0xa0, (data[at + 1] ?? 0) - 0x15, (data[at + 2] ?? 0) - 0x77) < 30) count += 1;
    return count;
  });
}

it(
  'the switch draws what is reached, the farthest landings are taken, and the link shows it again',
  async () => {
    const { page, complaints } = await open(browser, `${service.address}/${await toFragment(banks(2, { footprint: COARSE }))}`);
    await refined(page);
    await page.getByRole('button', { name: 'Zoom to footprint' }).waitFor();
    await expect.poll(() => pixelsOfEdge(page), { timeout: 10_000 }).toBeGreaterThan(300);
    const violations = await page.evaluate(
      `${source('axe-core/axe.min.js')}; axe.run().then((found) => found.violations.map(({ id, impact, nodes }) => [id, impact, nodes[0].html]))`,
    );
    expect((violations as string[][]).filter(([, impact]) => impact === 'serious' || impact === 'critical')).toEqual([]);

    const [map] = await Promise.all([
      page.waitForEvent('download', { timeout: 60_000 }),
      page.getByRole('button', { name: 'Footprint GeoJSON' }).click(),
    ]);
    expect(map.suggestedFilename()).toMatch(/\.footprint\.geojson$/);
    expect(JSON.parse(readFileSync(await map.path(), 'utf8')).type).toBe('FeatureCollection');
    await page.getByRole('button', { name: 'curl /footprint' }).click();
    await page.getByText('curl command of /footprint copied').waitFor();

    const row = partOf(page).getByRole('row', { name: /^Greatest downrange/ });
    const cells = await row.locator('th, td').allTextContents();
    const degrees = (text: string | undefined) => Number(text?.replace('−', '-').replace('°', ''));
    await row.getByRole('button', { name: 'Take the landing into the case: greatest downrange' }).click();
    const taken = async () => get(await caseOf(page), ['control', 'bank_angle', 'value']) as number[];
    await expect.poll(async () => (await taken())[0], { timeout: 10_000 }).toBeCloseTo(degrees(cells[2]), 2);
    const values = await taken();
    expect(values[1]).toBe(values[0]);
    expect(values[3]).toBe(values[2]);
    expect(values[2]).toBeCloseTo(degrees(cells[3]), 2);
    // The flight ends where the list has it, to the metres between two flights with numbers that differ in their last digits.
    const [latitude, longitude] = (cells[4] ?? '').split(', ').map(degrees) as [number, number];
    await expect
      .poll(async () => (await figure(page, 'Final position')).split(', ').map(degrees)[0], { timeout: 10_000 })
      .toBeCloseTo(latitude, 3);
    expect((await figure(page, 'Final position')).split(', ').map(degrees)[1]).toBeCloseTo(longitude, 3);
    expect(complaints).toEqual([]);

    const { page: again } = await open(browser, page.url());
    await refined(again);
    await again.getByRole('button', { name: 'Footprint', exact: true, pressed: true }).first().waitFor();
    await page.close();
    await again.close();
  },
  PATIENCE,
);

it('is switched on in the head of the flight, asks for a free number, and is off again', async () => {
  const { page } = await open(browser, `${service.address}/${await toFragment(banks(0, {}))}`);
  await page.getByRole('button', { name: 'Footprint', exact: true }).first().click();
  await partOf(page).getByText('Free one to 8 numbers').waitFor();
  await page.getByRole('region', { name: 'Target', exact: true }).getByLabel('Free a number').selectOption({ label: 'Air density' });
  await refined(page);
  await page.getByRole('region', { name: 'Target', exact: true }).getByRole('button', { name: 'Footprint', exact: true }).click();
  await partOf(page).waitFor({ state: 'detached' });
  await expect.poll(async () => (await caseOf(page)).footprint, { timeout: 10_000 }).toBeUndefined();
  await page.close();
});

it('a case of /footprint opens with it, its limits, and the edge without them', async () => {
  const { page } = await open(browser, service.address);
  const buffer = Buffer.from(JSON.stringify(banks(1, { limits: [{ quantity: 'load_factor', at: 'peak', at_most: 12 }], resolution: 2e4 })));
  await page.locator('#file').setInputFiles({ name: 'footprint.json', mimeType: 'application/json', buffer });
  await refined(page);
  await page.getByText('peak load factor at most 12 g').waitFor();
  await partOf(page).getByText('without limits').waitFor({ timeout: 60_000 });
  expect((await caseOf(page)).footprint).toEqual({ resolution: 2e4 });
  await page.close();
});

it('is asked for coarsely while a slider moves, and as it is to be at rest', async () => {
  const { page } = await open(browser, `${service.address}/${await toFragment(banks(1, { footprint: COARSE }))}`);
  await refined(page);
  const asked: FootprintRequest[] = [];
  page.on('request', (request) => {
    if (request.url().endsWith('/footprint')) asked.push(request.postDataJSON());
  });
  const slider = page.getByLabel('Mass', { exact: true }).first();
  await slider.focus();
  for (let press = 0; press < 5; press += 1) await slider.press('ArrowRight');
  const isCoarse = ({ search }: FootprintRequest) => search?.flights === 1500;
  // The last is as exact as it is to be, and of the mass at rest, which the address has.
  const before = banks(1, {}).vehicle.mass;
  const isAtRest = async () => {
    const [last, { mass }] = [asked.at(-1), (await caseOf(page)).vehicle];
    return last !== undefined && !isCoarse(last) && last.vehicle.mass === mass && mass !== before;
  };
  await expect.poll(isAtRest, { timeout: 40_000 }).toBe(true);
  await refined(page);
  expect(isCoarse(asked[0] as FootprintRequest)).toBe(true);
  expect(asked[0]?.resolution).toBe(5 * COARSE.resolution);
  expect(isCoarse(asked.at(-1) as FootprintRequest)).toBe(false);
  await page.close();
});
