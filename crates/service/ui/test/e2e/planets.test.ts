import { expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';
import { browser, example, figure, type Opened, open, prepare, service } from './browser';

prepare();

/** Opens the page on a case. */
async function on(tree: Case): Promise<Opened> {
  return open(browser, `${service.address}/${await toFragment(tree)}`);
}

/** Enters from an altitude, which any planet has. */
const ENTRY: Case = {
  ...example('mars'),
  initial_state: {
    type: 'planet_relative',
    altitude: 120000,
    longitude: 0,
    geocentric_latitude: 0,
    speed: 6000,
    flight_path_angle: -14,
    heading: 0,
  },
};

const caseOf = async ({ page }: Opened) => (await fromFragment(new URL(page.url()).hash)) as Case;

/** The colours of a map beside the track, each with its share of the pixels. */
async function coloursOf({ page }: Opened): Promise<number[]> {
  const map = page.locator('canvas.world');
  await map.scrollIntoViewIfNeeded();
  await page.waitForTimeout(300);
  return map.evaluate((canvas: HTMLCanvasElement) => {
    const { width, height } = canvas;
    const { data } = (canvas.getContext('2d') as CanvasRenderingContext2D).getImageData(0, 0, width, height);
    const counts = new Map<number, number>();
    for (let index = 0; index < data.length; index += 4) {
      const colour = ((data[index] as number) << 16) | ((data[index + 1] as number) << 8) | (data[index + 2] as number);
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
    }
    return [...counts.values()].map((count) => count / (width * height)).sort((a, b) => b - a);
  });
}

it('the map of Mars has no coast, and says that it is Mars', async () => {
  const earth = await on(example('sample_return'));
  await earth.page.getByRole('heading', { name: 'Ground track on the Earth' }).waitFor();
  // Sea and land.
  const [, land] = await coloursOf(earth);
  expect(land).toBeGreaterThan(0.1);
  await earth.page.close();

  const mars = await on(example('mars'));
  await mars.page.getByRole('heading', { name: 'Ground track on Mars' }).waitFor();
  await mars.page.getByLabel(/^Map of Mars with the track/).waitFor();
  await mars.page.getByLabel(/^Globe of Mars with the track/).waitFor();
  await mars.page.getByText('There is no picture of Mars').waitFor();
  const [ground, ...others] = await coloursOf(mars);
  expect(ground).toBeGreaterThan(0.9);
  // Of the rest most are meridians and parallels.
  expect(others[0]).toBeLessThan(0.08);
  await mars.page.locator('.card', { hasText: 'g of the Earth' }).waitFor();
  expect(mars.complaints).toEqual([]);
  await mars.page.close();
});

it('maps of a format are offered where viewers have a globe of the planet', async () => {
  for (const [name, offered] of [
    ['sample_return', ['GeoJSON', 'KML', 'CZML']],
    ['mars', ['GeoJSON', 'KML']],
    ['titan', ['GeoJSON']],
  ] as const) {
    const { page } = await on(example(name));
    for (const format of ['GeoJSON', 'KML', 'CZML'] as const)
      expect(await page.getByRole('button', { name: format, exact: true }).isEnabled()).toBe(
        (offered as readonly string[]).includes(format),
      );
    if (name === 'titan') await page.getByText('KML and CZML: viewers have no globe of Titan. GeoJSON names the planet.').waitFor();
    await page.close();
  }
});

it('another planet takes its own air in place of that of the Earth, and says so', async () => {
  const opened = await on(example('sample_return'));
  const { page } = opened;
  await page.locator('summary', { hasText: /^Planet/ }).click();
  await page.locator('summary', { hasText: 'Atmosphere and wind' }).click();
  const planet = page.locator('#field\\/planet\\/model');
  const air = page.locator('#field\\/atmosphere\\/type');
  const said = page.locator('.settled', { hasText: 'standard one of Mars, in place of the U.S. Standard Atmosphere 1976' });
  await planet.selectOption('mars');
  await said.first().waitFor();
  expect(await said.count()).toBe(2);
  expect(await air.inputValue()).toBe('standard');
  expect(await page.locator('#field\\/planet\\/gravity\\/j2').getAttribute('placeholder')).toBe('that of Mars');
  await expect.poll(() => caseOf(opened)).toMatchObject({ planet: { model: 'mars' }, atmosphere: { type: 'standard' } });
  // What was the Earth's comes back by the undo, and the words go.
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect.poll(() => air.inputValue()).toBe('us76');
  expect(await said.count()).toBe(0);
  // Without an atmosphere the form says which one is used.
  await air.selectOption('');
  expect(await air.locator('option:checked').textContent()).toBe('Exponential (default)');
  await planet.selectOption('titan');
  await expect.poll(() => air.locator('option:checked').textContent()).toBe('Standard of Titan (default)');
  await page.locator('summary', { hasText: /^Planet/ }).waitFor();
  await page.close();
});

it('the numbers of a custom planet stay with it', async () => {
  const numbers = { gravitational_parameter: 4.28e13, equatorial_radius: 3.4e6, polar_radius: 3.4e6, rotation_rate: 7e-5 };
  const custom = { ...ENTRY, planet: { model: 'custom', ...numbers }, atmosphere: { type: 'vacuum' }, heating: undefined };
  const opened = await on(custom as unknown as Case);
  const { page } = opened;
  await page.getByRole('heading', { name: 'Ground track on a custom planet' }).waitFor();
  await page.locator('summary', { hasText: /^Planet/ }).click();
  const planet = page.locator('#field\\/planet\\/model');
  await planet.selectOption('venus');
  await expect.poll(async () => (await caseOf(opened)).planet).toEqual({ model: 'venus' });
  await page.getByRole('heading', { name: 'Ground track on Venus' }).waitFor();
  await planet.selectOption('custom');
  await expect.poll(async () => (await caseOf(opened)).planet).toEqual({ model: 'custom', ...numbers });
  await page.close();
});

it('a flight on another planet is compared, and not drawn on the map', async () => {
  const { page } = await on(ENTRY);
  await page.getByRole('button', { name: 'Pin this flight' }).click();
  const before = await figure(page, 'Time');
  await page.locator('summary', { hasText: /^Planet/ }).click();
  await page.locator('#field\\/planet\\/model').selectOption('earth_wgs84');
  await expect.poll(() => figure(page, 'Time')).not.toBe(before);
  await page.getByText('A pinned flight is on another planet and not shown.').waitFor();
  await page
    .getByRole('row', { name: /^Distance between end points/ })
    .getByText('other planet')
    .waitFor();
  await page.close();
});
