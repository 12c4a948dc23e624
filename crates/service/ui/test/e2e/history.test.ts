import type { Page } from 'playwright-core';
import { describe, expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';
import { browser, example, figure, open, prepare, service } from './browser';

prepare();

async function on(tree: Case): Promise<Page> {
  return (await open(browser, `${service.address}/${await toFragment(tree)}`)).page;
}

const field = (page: Page, pointer: string) => page.locator(`#field${pointer.replaceAll('/', '\\/')}`);
const caseOf = async (page: Page) => (await fromFragment(new URL(page.url()).hash)) as Case;
const nameOf = (page: Page) => page.locator('#name').inputValue();

async function openExample(page: Page, title: string): Promise<void> {
  await page.getByLabel('Open', { exact: true }).selectOption({ label: title });
  await expect.poll(() => nameOf(page)).toContain(title);
}

async function openText(page: Page, name: string, text: string): Promise<void> {
  await page.locator('#file').setInputFiles({ name, mimeType: 'application/json', buffer: Buffer.from(text) });
}

describe('undo', () => {
  it('takes back what was typed, and redo does it again', async () => {
    const page = await on(example('target_2'));
    const mass = field(page, '/vehicle/mass');
    const undo = page.getByRole('button', { name: 'Undo' });
    const name = await nameOf(page);
    expect(await undo.isDisabled()).toBe(true);
    await mass.fill('750');
    await page.locator('#name').fill('another');
    const shows = (value: string, title: string) =>
      expect.poll(async () => [await mass.inputValue(), await nameOf(page)]).toEqual([value, title]);
    await page.keyboard.press('Control+z');
    await shows('750', name);
    await undo.click();
    await shows('700', name);
    expect(await undo.isDisabled()).toBe(true);
    await page.keyboard.press('Control+Shift+z');
    await shows('750', name);
    await page.keyboard.press('Control+y');
    await shows('750', 'another');
    expect(await page.getByRole('button', { name: 'Redo' }).isDisabled()).toBe(true);
    await page.close();
  });

  it('takes back a whole drag at once', async () => {
    const page = await on(example('target_2'));
    const slider = page.locator('#slider-vehicle-mass');
    const box = await slider.boundingBox();
    if (!box) throw new Error('the slider has no place');
    for (const to of [0.8, 0.2]) {
      await page.mouse.move(box.x + box.width / 3, box.y + box.height / 2);
      await page.mouse.down();
      await page.mouse.move(box.x + box.width * 0.5, box.y + box.height / 2, { steps: 5 });
      // As long as it is held it is one drag.
      await page.waitForTimeout(800);
      await page.mouse.move(box.x + box.width * to, box.y + box.height / 2, { steps: 5 });
      await page.mouse.up();
    }
    const mass = field(page, '/vehicle/mass');
    expect(Number(await mass.inputValue())).toBeLessThan(700);
    await page.keyboard.press('Control+z');
    await expect.poll(async () => Number(await mass.inputValue())).toBeGreaterThan(700);
    await page.keyboard.press('Control+z');
    await expect.poll(() => mass.inputValue()).toBe('700');
    expect(await page.getByRole('button', { name: 'Undo' }).isDisabled()).toBe(true);
    await page.close();
  });

  it('takes back an example that was opened', async () => {
    const page = await on({ ...example('target_2'), name: 'mine' });
    await openExample(page, 'Capsule from orbit');
    await page.getByRole('button', { name: 'Undo' }).click();
    await expect.poll(() => nameOf(page)).toBe('mine');
    await page.close();
  });
});

it('Back returns to the case before an example, a file or a new case, as it was left', async () => {
  const page = await on({ ...example('target_2'), name: 'mine' });
  await field(page, '/vehicle/mass').fill('750');
  await openExample(page, 'Capsule from orbit');
  await openText(page, 'case.json', JSON.stringify({ ...example('target_1'), name: 'of a file' }));
  await expect.poll(() => nameOf(page)).toBe('of a file');
  await page.getByRole('button', { name: 'New', exact: true }).click();
  await expect.poll(() => nameOf(page)).toBe('New case');
  await expect.poll(async () => (await caseOf(page)).name).toBe('New case');
  for (const name of ['of a file', 'Capsule from orbit', 'mine']) {
    await page.goBack();
    await expect.poll(() => nameOf(page)).toBe(name);
  }
  await expect.poll(() => field(page, '/vehicle/mass').inputValue()).toBe('750');
  await page.goForward();
  await expect.poll(() => nameOf(page)).toBe('Capsule from orbit');
  await page.close();
});

it('a new case has standard air and degrees, flies to the ground, and gets no warning', async () => {
  const page = await on(example('target_2'));
  await page.getByRole('button', { name: 'New', exact: true }).click();
  await expect.poll(async () => (await caseOf(page)).name).toBe('New case');
  expect(await caseOf(page)).toMatchObject({ angle_unit: 'deg', atmosphere: { type: 'standard' } });
  await page.locator('.card', { hasText: 'Impact' }).waitFor();
  expect(await page.locator('.notice').count()).toBe(0);
  await page.close();
});

it.each([
  ['track.geojson', '{"type": "FeatureCollection", "features": []}', 'vehicle and initial_state are missing'],
  ['list.json', '[1, 2]', 'it is not a JSON object'],
  ['text.json', 'altitude,speed', 'is not a valid case'],
])('%s, which is no case, replaces nothing', async (name, text, why) => {
  const page = await on(example('target_2'));
  const before = await caseOf(page);
  await openText(page, name, text);
  await page.getByText(why).waitFor();
  await page.waitForTimeout(500);
  expect(await caseOf(page)).toEqual(before);
  expect(await field(page, '/vehicle/mass').inputValue()).toBe('700');
  expect(await page.getByRole('button', { name: 'Undo' }).isDisabled()).toBe(true);
  await page.close();
});

it('tables are there again where another kind was chosen and then theirs', async () => {
  const page = await on(example('lifting_capsule'));
  const aerodynamics = page.getByLabel('Aerodynamics', { exact: true }).first();
  const tree = await caseOf(page);
  await aerodynamics.selectOption('constant');
  await field(page, '/vehicle/aerodynamics/drag_coefficient').fill('1.3');
  await aerodynamics.selectOption('alpha_mach_table');
  await expect.poll(() => caseOf(page)).toEqual(tree);
  await aerodynamics.selectOption('constant');
  expect(await field(page, '/vehicle/aerodynamics/drag_coefficient').inputValue()).toBe('1.3');
  // A schedule, and a part that may be left out, too.
  await aerodynamics.selectOption('alpha_mach_table');
  await page.getByLabel('Bank angle schedule').uncheck();
  await page.getByLabel('Bank angle schedule').check();
  await expect.poll(() => caseOf(page)).toEqual(tree);
  // But nothing of it comes into another case.
  await openExample(page, 'Capsule from orbit');
  await aerodynamics.selectOption('alpha_mach_table');
  await expect.poll(async () => (await caseOf(page)).vehicle.aerodynamics).toEqual({ type: 'alpha_mach_table' });
  await page.close();
});

it('the cases that were worked on are there on the next visit, and examples that were only looked at are not', async () => {
  const page = await on({ ...example('target_2'), name: 'mine' });
  await field(page, '/vehicle/mass').fill('750');
  await openExample(page, 'Capsule from orbit');
  await openExample(page, 'Lifting capsule');
  const next = await page.context().newPage();
  await next.goto(service.address);
  await next.locator('[data-figure="Time"]').waitFor();
  const found = await next.locator('optgroup[label="Recent"] option').allTextContents();
  expect(found).toEqual([expect.stringMatching(/^mine, /)]);
  await next.getByLabel('Open', { exact: true }).selectOption({ label: found[0] as string });
  await expect.poll(() => field(next, '/vehicle/mass').inputValue()).toBe('750');
  await expect.poll(() => figure(next, 'Time')).not.toBe('');
  await page.context().close();
});

it('what is kept of the cases is 20 of them, and what is no case is passed over', async () => {
  const page = await on({ ...example('target_2'), name: 'mine' });
  const entry = (index: number) => ({ id: index, at: index, case: { ...example('target_1'), name: `case ${index}` } });
  await page.evaluate(
    (text) => localStorage.setItem('recent', text),
    JSON.stringify([...Array(20).keys()].map(entry).concat(null as never)),
  );
  await page.reload();
  await field(page, '/vehicle/mass').fill('750');
  const names = () => page.locator('optgroup[label="Recent"] option').allTextContents();
  await expect.poll(async () => (await names())[0]).toMatch(/^mine, /);
  expect(await names()).toHaveLength(20);
  await page.close();
});

describe('units of angles are the reader’s', () => {
  const angle = '/initial_state/flight_path_angle';

  it('an example in radians is read and typed in degrees, and keeps its own numbers', async () => {
    const tree = example('target_2');
    expect(tree.angle_unit ?? 'rad').toBe('rad');
    const page = await on(tree);
    expect(await page.getByRole('button', { name: 'deg', exact: true }).getAttribute('aria-pressed')).toBe('true');
    expect(Number(await field(page, angle).inputValue())).toBeCloseTo(-30, 4);
    expect(await page.getByText('Final flight-path angle').locator('..').textContent()).toContain('°');
    expect(await page.locator('.slider', { hasText: 'Flight-path angle' }).textContent()).toContain('−30 °');
    await field(page, '/control/bank_angle').fill('60');
    await expect.poll(async () => (await caseOf(page)).control?.bank_angle).toBe((60 * Math.PI) / 180);
    for (const unit of ['rad', 'deg']) await page.getByRole('button', { name: unit, exact: true }).click();
    expect(await field(page, '/control/bank_angle').inputValue()).toBe('60');
    expect(await caseOf(page)).toEqual({ ...tree, control: { bank_angle: (60 * Math.PI) / 180 } });
    await page.close();
  });

  it('are the same after an example in the other unit, and on the next visit', async () => {
    const page = await on(example('target_2'));
    await page.getByRole('button', { name: 'rad', exact: true }).click();
    await openExample(page, 'Capsule from orbit');
    expect(Number(await field(page, '/control/bank_angle').inputValue())).toBeCloseTo(Math.PI / 3, 12);
    expect(await page.locator('[data-figure="Final position"]').textContent()).toContain('rad');
    await expect.poll(async () => (await caseOf(page)).control?.bank_angle).toBe(60);
    await page.reload();
    expect(await page.getByRole('button', { name: 'rad', exact: true }).getAttribute('aria-pressed')).toBe('true');
    expect((await caseOf(page)).control?.bank_angle).toBe(60);
    await page.close();
  });

  it('a schedule is typed in them too', async () => {
    const page = await on({ ...example('target_2'), control: { bank_angle: { type: 'schedule', against: 'time', at: [0], value: [0] } } });
    await field(page, '/control/bank_angle/at').fill('0 0\n5 60');
    await expect.poll(async () => (await caseOf(page)).control?.bank_angle).toMatchObject({ at: [0, 5], value: [0, (60 * Math.PI) / 180] });
    expect(await field(page, '/control/bank_angle/at').inputValue()).toBe('0 0\n5 60');
    await page.close();
  });
});
