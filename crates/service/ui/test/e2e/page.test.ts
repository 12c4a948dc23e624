import { describe, expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { figuresOf, number } from '../../src/figures';
import { flightOf } from '../../src/flight';
import { type Field, SECTIONS } from '../../src/form/fields';
import { fromFragment, toFragment } from '../../src/link';
import { ask, browser, example, figure, type Opened, open, prepare, service, shows, source } from './browser';

/** The kinds of an initial state that is converted: all but a launch. */
const COORDINATES = Object.keys((SECTIONS.initial_state as Extract<Field, { kind: 'variant' }>).kinds).filter((type) => type !== 'launch');

prepare();

/** Opens the page on a case. */
async function on(tree: Case, options = {}): Promise<Opened> {
  return open(browser, `${service.address}/${await toFragment(tree)}`, options);
}

const CAPSULE: Case = {
  angle_unit: 'deg',
  vehicle: { mass: 5500, reference_area: 12, aerodynamics: { type: 'constant', drag_coefficient: 1.3 } },
  initial_state: {
    type: 'planet_relative',
    altitude: 120000,
    longitude: -40,
    geocentric_latitude: 10,
    speed: 7500,
    flight_path_angle: -3,
    heading: 30,
  },
};

/** The figures of a case as the page should show them, by the answer of the service; angles as most read them. */
async function expected(tree: Case): Promise<[string, string][]> {
  const answer = await ask(service.address, 'simulate', tree);
  return figuresOf(flightOf(answer), 'deg').map(({ label, value }) => [label, typeof value === 'number' ? number(value) : value]);
}

describe('the figures on the page are those of the API', () => {
  it('for each example, and each case of the thesis is one', async () => {
    const { page, complaints } = await open(browser, service.address);
    const choose = page.getByLabel('Open', { exact: true });
    const titles = await choose.locator('option').allTextContents();
    expect(titles.filter((title) => title.startsWith('Table'))).toHaveLength(7);
    for (const title of titles.slice(1)) {
      const before = page.url();
      await choose.selectOption({ label: title });
      await page.waitForURL((url) => url.href !== before || title === titles[1]);
      const tree = (await fromFragment(new URL(page.url()).hash)) as Case;
      for (const [label, value] of await expected(tree)) await shows(page, label, value);
    }
    expect(complaints).toEqual([]);
    await page.close();
  });
});

it('every example downloads in every format', async () => {
  const { page } = await open(browser, service.address);
  const choose = page.getByLabel('Open', { exact: true });
  const titles = (await choose.locator('option').allTextContents()).slice(1);
  expect(titles.length).toBeGreaterThan(15);
  for (const title of titles) {
    await choose.selectOption({ label: title });
    for (const format of ['CSV', 'JSON', 'GeoJSON', 'KML', 'CZML', 'OEM']) {
      const button = page.getByRole('button', { name: format, exact: true }).last();
      if (await button.isDisabled()) {
        // Only what the service refuses is not offered.
        const tree = await fromFragment(new URL(page.url()).hash);
        const refusal = await ask(service.address, `simulate?format=${format.toLowerCase()}`, tree);
        expect(refusal.errors?.[0]?.pointer).toBeOneOf(format === 'OEM' ? ['/planet/model', '/epoch'] : ['/planet/model']);
        continue;
      }
      const [download] = await Promise.all([page.waitForEvent('download'), button.click()]);
      expect(download.suggestedFilename()).toMatch(new RegExp(`\\.${format}$`, 'i'));
      expect(await download.failure()).toBeNull();
      await page.getByText(`${format.toUpperCase()} saved`).waitFor();
      // Chromium drops downloads that a page starts too fast, one after the other.
      await page.waitForTimeout(150);
    }
  }
  await page.close();
}, 240_000);

it('a flight that stops above the ground is nowhere said to hit it', async () => {
  const { page } = await on({ ...example('target_2'), stop: { altitude: 8000 } });
  await page.locator('.card', { hasText: 'Stopped at 8 km' }).waitFor();
  await page.locator('.places', { hasText: 'stopped at 8 km' }).waitFor();
  expect(await page.getByText(/impact/i).count()).toBe(0);
  await page.close();
});

it('a case says what to know of it: the flown capsules come down in Utah', async () => {
  const { page } = await open(browser, service.address);
  for (const [title, south] of [
    ['Stardust, 15 January 2006', '160 km'],
    ['Genesis, 8 September 2004', '130 km'],
  ] as const) {
    await page.getByLabel('Open', { exact: true }).selectOption({ label: title });
    await page.getByRole('heading', { name: title }).waitFor();
    expect(await page.locator('.notes').textContent()).toContain(`${south} south of the actual landing point`);
    const [latitude, longitude] = (await figure(page, 'Final position')).split(', ').map(Number.parseFloat);
    expect(latitude).toBeCloseTo(39, 0);
    expect(longitude).toBeGreaterThan(-113.6);
    expect(longitude).toBeLessThan(-113.3);
  }
  await page.close();
});

describe('a form', () => {
  it('takes every type of state, converted in place, and the flight stays', async () => {
    const { page, complaints } = await on(CAPSULE);
    const time = Number(await figure(page, 'Time'));
    const coordinates = page.getByLabel('Coordinates');
    for (const type of COORDINATES.reverse()) {
      await coordinates.selectOption(type);
      await expect.poll(async () => (await fromFragment(new URL(page.url()).hash))?.initial_state.type).toBe(type);
      // Conversions round: the end moves by less than a millionth.
      await expect.poll(async () => Math.abs(Number(await figure(page, 'Time')) - time)).toBeLessThan(1e-3);
      expect(await page.locator('[aria-invalid="true"]').count()).toBe(0);
    }
    expect(complaints).toEqual([]);
    await page.close();
  });

  it('says what the API says, beside the field', async () => {
    const { page } = await on(CAPSULE);
    const mass = page.getByLabel('Mass', { exact: true }).last();
    await mass.fill('-13');
    const fault = page.locator('#field\\/vehicle\\/mass-fault');
    await fault.waitFor();
    const problem = await ask(service.address, 'simulate', { ...CAPSULE, vehicle: { ...CAPSULE.vehicle, mass: -13 } });
    expect(await fault.textContent()).toBe(problem.errors[0].detail);
    expect(await mass.getAttribute('aria-invalid')).toBe('true');
    await mass.fill('twelve');
    await expect.poll(() => fault.textContent()).toBe('must be a number, got a string');
    await mass.fill('5500');
    await expect.poll(() => fault.count()).toBe(0);
    await page.close();
  });

  it('flies as one types, and with the other unit the same flight', async () => {
    const { page } = await on(CAPSULE);
    await page.locator('#field\\/initial_state\\/flight_path_angle').fill('-5');
    const steeper = { ...CAPSULE, initial_state: { ...CAPSULE.initial_state, flight_path_angle: -5 } } as Case;
    const figures = new Map(await expected(steeper));
    await shows(page, 'Time', figures.get('Time') as string);
    await page.getByRole('button', { name: 'rad', exact: true }).click();
    await expect.poll(() => page.locator('#field\\/initial_state\\/flight_path_angle').inputValue()).toMatch(/^-0\.08726/);
    await shows(page, 'Time', figures.get('Time') as string);
    await page.close();
  });

  it('shows the case as it is now, whatever an earlier answer says that comes late', async () => {
    const { page } = await on(CAPSULE);
    const steeper = { ...CAPSULE, initial_state: { ...CAPSULE.initial_state, flight_path_angle: -4 } } as Case;
    const time = new Map(await expected(steeper)).get('Time') as string;
    await page.route('**/simulate', async (route) => {
      if (route.request().postDataJSON().initial_state.flight_path_angle === -6) await new Promise((resolve) => setTimeout(resolve, 500));
      await route.continue().catch(() => {});
    });
    const angle = page.locator('#field\\/initial_state\\/flight_path_angle');
    await angle.fill('-6');
    await page.waitForTimeout(100);
    await angle.fill('-4');
    await shows(page, 'Time', time);
    await page.waitForTimeout(700);
    expect(await figure(page, 'Time')).toBe(time);
    await page.close();
  });

  it('says that the service does not answer, and flies again once it does', async () => {
    const { page } = await on(CAPSULE);
    await page.route('**/simulate', (route) => route.abort());
    await page.locator('#field\\/vehicle\\/mass').fill('6000');
    await page.getByText('The service does not respond. Check that it is running.').waitFor();
    await page.unroute('**/simulate');
    await page.locator('#field\\/vehicle\\/mass').fill('6001');
    await expect.poll(() => page.getByText('The service does not respond. Check that it is running.').count()).toBe(0);
    await page.close();
  });

  it.each([
    ['atmosphere', 'Atmosphere and wind', 'Atmosphere', ['us76', 'vacuum', 'exponential', 'layered_exponential']],
    ['planet gravity', 'Planet', 'Gravity', ['zonal', 'inverse_square']],
    ['wind', 'Atmosphere and wind', 'Wind', ['constant']],
  ])('offers each kind of %s', async (_, fold, label, types) => {
    const { page } = await on(CAPSULE);
    await page.locator('summary', { hasText: fold }).click();
    for (const type of types) {
      await page.getByLabel(label, { exact: true }).selectOption(type);
      await expect.poll(async () => JSON.stringify(await fromFragment(new URL(page.url()).hash))).toContain(`"type":"${type}"`);
    }
    await page.close();
  });

  it('adds events, heating and stop conditions', async () => {
    const { page } = await on({ ...CAPSULE, vehicle: { ...CAPSULE.vehicle, nose_radius: 1 } });
    await page.locator('summary', { hasText: 'Events' }).click();
    await page.getByRole('button', { name: 'Add an event' }).click();
    await page.locator('summary', { hasText: 'Heating' }).click();
    await page.getByLabel(/Compute heat fluxes/).check();
    await page.locator('[data-figure="Heat load"]').waitFor();
    await page.locator('summary', { hasText: 'Stop' }).click();
    await page.getByRole('button', { name: 'Add a condition' }).click();
    await page.getByLabel('Falls below or Rises above').last().selectOption('rises_through');
    await page.locator('#field\\/stop\\/when\\/0\\/rises_through').fill('2');
    await expect.poll(() => figure(page, 'Peak load factor')).toBe('2');
    await page.close();
  });
});

describe('taken along', () => {
  it('a link reproduces the run', async () => {
    const { page } = await on(example('target_2'));
    await page.locator('#field\\/vehicle\\/mass').fill('750');
    await shows(
      page,
      'Time',
      new Map(await expected({ ...example('target_2'), vehicle: { ...example('target_2').vehicle, mass: 750 } })).get('Time') as string,
    );
    await page.getByRole('button', { name: 'Link' }).click();
    await page.getByText('Link copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const figures = await page.locator('[data-figure]').allTextContents();
    await page.close();
    const other = await open(browser, link);
    expect(await other.page.locator('[data-figure]').allTextContents()).toEqual(figures);
    await other.page.close();
  });

  it('the CSV that is downloaded is that of the API', async () => {
    const { page } = await on(example('target_1'));
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'CSV' }).click()]);
    expect(download.suggestedFilename()).toBe('TARGET_reference_case_1.csv');
    const stream = await download.createReadStream();
    let text = '';
    for await (const chunk of stream) text += chunk;
    const response = await fetch(`${service.address}/simulate?format=csv`, {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify(example('target_1')),
    });
    expect(text).toBe(await response.text());
    await page.close();
  });

  it('a file that is dropped on the page is flown', async () => {
    const { page } = await on(CAPSULE);
    await page
      .locator('#file')
      .setInputFiles({ name: 'case.json', mimeType: 'application/json', buffer: Buffer.from(JSON.stringify(example('target_1'))) });
    await shows(page, 'Time', '23.9377');
    const data = await page.evaluateHandle(
      (text) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([text], 'case.json', { type: 'application/json' }));
        return transfer;
      },
      JSON.stringify(example('impulse')),
    );
    await page.dispatchEvent('body', 'drop', { dataTransfer: data });
    await shows(page, 'Time', '1709.81');
    await page.close();
  });
});

it('a pinned flight stays, and a table shows the differences', async () => {
  const { page } = await on(CAPSULE);
  const before = await figure(page, 'Time');
  await page.getByRole('button', { name: 'Pin this flight' }).click();
  await page.locator('#field\\/vehicle\\/mass').fill('6000');
  await expect.poll(() => figure(page, 'Time')).not.toBe(before);
  const row = page.getByRole('row', { name: /^Time/ });
  const [now, then] = await row.locator('td').allTextContents();
  expect(now).toBe(await figure(page, 'Time'));
  const [value, difference] = (then as string).split(' ');
  expect(value).toBe(before);
  expect(Number(difference?.replace('−', '-'))).toBeCloseTo(Number(before) - Number(now), 2);
  await page.close();
});

it('a theory says where it holds, as the API does', async () => {
  const tree = example('steep_ballistic');
  const { page } = await on(tree);
  const answer = await ask(service.address, 'analytic', tree);
  await page.getByText(answer.valid.ends_because).waitFor();
  const choose = page.getByLabel('Overlay');
  expect(await choose.inputValue()).toBe('steep_ballistic');
  await choose.selectOption('loh');
  const refusal = await ask(service.address, 'analytic', { ...tree, solution: 'loh' });
  await page.getByText(refusal.errors[0].detail).waitFor();
  await page.close();
});

it('asks nobody but the service, keeps its own rules, and works when the network is gone from elsewhere', async () => {
  const { page, requests, complaints } = await open(browser, service.address);
  await page.waitForLoadState('networkidle');
  expect(requests.filter((url) => !url.startsWith(service.address))).toEqual([]);
  expect(complaints).toEqual([]);
  const first = await fetch(`${service.address}/`);
  expect(first.headers.get('content-security-policy')).toContain("default-src 'none'");
  await page.close();
});

it('its first paint takes less than 100 kB', async () => {
  const html = await (await fetch(service.address)).text();
  const files = ['', ...[...html.matchAll(/(?:src|href)="\.\/(assets\/[^"]+)"/g)].map(([, path]) => path as string)];
  let bytes = 0;
  for (const file of files) {
    const response = await fetch(`${service.address}/${file}`, { headers: { 'accept-encoding': 'gzip' } });
    bytes += Number(response.headers.get('content-length'));
  }
  expect(files.length).toBeGreaterThan(2);
  expect(bytes).toBeGreaterThan(10_000);
  expect(bytes).toBeLessThan(100_000);
});

describe.each([
  ['a phone, light', { viewport: { width: 360, height: 760 }, colorScheme: 'light' }],
  ['a desk, dark', { viewport: { width: 1440, height: 1000 }, colorScheme: 'dark' }],
  ['a tablet, light', { viewport: { width: 768, height: 1000 }, colorScheme: 'light' }],
  ['a phone, dark', { viewport: { width: 360, height: 760 }, colorScheme: 'dark' }],
  ['a desk, light', { viewport: { width: 1440, height: 1000 }, colorScheme: 'light' }],
] as const)('on %s', (_, options) => {
  it('nothing is wider than the screen, and axe finds nothing serious', async () => {
    const { page } = await on({ ...example('deorbit'), name: 'Capsule from orbit' }, options);
    await page.waitForLoadState('networkidle');
    const views = options.viewport.width < 900 ? ['Case', 'Flight'] : [''];
    for (const view of views) {
      if (view) await page.getByRole('button', { name: view, exact: true }).last().click();
      let opened = 0;
      for (const fold of await page.locator('details > summary').all()) {
        if (!(await fold.isVisible())) continue;
        if (!(await fold.evaluate((summary) => (summary.parentElement as HTMLDetailsElement).open))) await fold.click();
        opened += 1;
        expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(options.viewport.width);
      }
      expect(opened).toBeGreaterThan(view === 'Flight' ? 1 : 8);
      const violations = await page.evaluate(
        `${source('axe-core/axe.min.js')}; axe.run().then((found) => found.violations.map(({ id, impact, nodes }) => [id, impact, nodes[0].html]))`,
      );
      expect((violations as string[][]).filter(([, impact]) => impact === 'serious' || impact === 'critical')).toEqual([]);
    }
    await page.close();
  });
});

it('the keyboard alone opens an example and varies it', async () => {
  const { page } = await on(CAPSULE);
  const before = await figure(page, 'Time');
  const reach = async (id: string) => {
    for (let presses = 0; presses < 40; presses += 1) {
      if ((await page.evaluate(() => document.activeElement?.id)) === id) return;
      await page.keyboard.press('Tab');
    }
    throw new Error(`${id} is not reached`);
  };
  await reach('example');
  await reach('slider-vehicle-mass');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  await expect.poll(() => figure(page, 'Time')).not.toBe(before);
  await page.close();
});
