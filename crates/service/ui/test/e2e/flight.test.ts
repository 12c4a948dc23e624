import { expect, it } from 'vitest';
import { toFragment } from '../../src/link';
import { ask, browser, example, type Opened, open, prepare, service } from './browser';

prepare();

async function on(name: string): Promise<Opened> {
  return open(browser, `${service.address}/${await toFragment(example(name))}`);
}

it('every plot and map draws something, and says what', async () => {
  const { page, complaints } = await on('deorbit');
  await page.getByLabel(/^World map with the track/).waitFor();
  const canvases = await page.locator('main canvas').all();
  expect(canvases.length).toBeGreaterThan(10);
  for (const canvas of canvases) {
    await canvas.scrollIntoViewIfNeeded();
    // Some pixels of several colours: axes, grid, curve.
    const colours = () =>
      canvas.evaluate((element) => {
        const { width, height } = element as HTMLCanvasElement;
        const bytes = (element as HTMLCanvasElement).getContext('2d')?.getImageData(0, 0, width, height).data ?? [];
        const found = new Set<number>();
        for (let at = 0; at < bytes.length; at += 4)
          if (bytes[at + 3] === 255) found.add(((bytes[at] ?? 0) << 16) | ((bytes[at + 1] ?? 0) << 8) | (bytes[at + 2] ?? 0));
        return found.size;
      });
    await expect.poll(colours).toBeGreaterThan(2);
  }
  for (const label of await page.locator('[role="img"]').evaluateAll((all) => all.map((element) => element.getAttribute('aria-label')))) {
    expect(label?.length).toBeGreaterThan(10);
    expect(label).not.toContain('NaN');
  }
  expect(complaints).toEqual([]);
  await page.close();
});

it('the instant is the same in every plot, by pointer and by keyboard', async () => {
  const { page } = await on('target_2');
  const plot = page.locator('.plot').first();
  const box = await plot.boundingBox();
  if (!box) throw new Error('the plot has no place');
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  const read = page.locator('.instant .quiet');
  await expect.poll(() => read.textContent()).toMatch(/ s · Altitude .* km · Speed .* m\/s/);
  expect(await page.locator('.plot-dot:visible').count()).toBeGreaterThan(1);
  const pointed = await read.textContent();
  await page.locator('#instant').focus();
  await page.keyboard.press('ArrowRight');
  await expect.poll(() => read.textContent()).not.toBe(pointed);
  await page.keyboard.press('Escape');
  await expect.poll(() => page.locator('.plot-dot').count()).toBe(0);
  await page.close();
});

it('each plot is read where it is, of every flight, and nothing moves meanwhile', async () => {
  const { page } = await on('target_2');
  await page.getByRole('button', { name: 'Pin this flight' }).click();
  await page.locator('#field\\/vehicle\\/mass').fill('900');
  await page.waitForTimeout(600);
  const card = page.locator('.plot-card', { hasText: 'Dynamic pressure' });
  const readings = card.locator('.reading');
  expect(await readings.allTextContents()).toEqual(['–', '–']);
  await card.scrollIntoViewIfNeeded();
  const places = () => page.locator('.plot').evaluateAll((all) => all.map((plot) => plot.getBoundingClientRect().top));
  const before = await places();
  const box = await card.locator('.u-over').boundingBox();
  if (!box) throw new Error('the plot has no place');
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 2);
  await expect.poll(() => readings.allTextContents()).toEqual([expect.stringMatching(/^\d/), expect.stringMatching(/^\d/)]);
  const [heavy, light] = await readings.allTextContents();
  expect(heavy).not.toBe(light);
  expect(await places()).toEqual(before);
  // The time line is in sight all the same.
  const line = await page.locator('.instant').boundingBox();
  expect(line?.y).toBeGreaterThanOrEqual(0);
  await page.close();
});

it('the dots stay on the curves where a plot is zoomed', async () => {
  const { page } = await on('target_2');
  const plot = page.locator('.plot .u-over').first();
  const box = await plot.boundingBox();
  if (!box) throw new Error('the plot has no place');
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  const dot = page.locator('.plot-dot').first();
  await dot.waitFor();
  const place = () => dot.evaluate((element) => (element as HTMLElement).style.transform);
  const before = await place();
  const [at] = await dot.evaluateAll((all) => all.map((element) => element.getBoundingClientRect().toJSON()));
  await page.mouse.move(at.x - 60, at.y - 40);
  await page.mouse.down();
  await page.mouse.move(at.x + 120, at.y + 60, { steps: 4 });
  await page.mouse.up();
  await expect.poll(place).not.toBe(before);
  await page.getByRole('button', { name: 'Reset zoom' }).click();
  await expect.poll(() => page.locator('.plot-dot').first().isVisible()).toBe(true);
  await page.close();
});

it('the table has the first and the last row of the flight', async () => {
  const { page } = await on('target_1');
  await page.getByText('Show as table').click();
  const rows = page.getByRole('region', { name: 'Flight', exact: true }).locator('tbody tr');
  expect(await rows.first().locator('td').first().textContent()).toBe('0.0000');
  expect(await rows.last().locator('td').first().textContent()).toBe('23.9377');
  await page.close();
});

it('the coordinates of the impact can be copied', async () => {
  const { page } = await on('target_1');
  await page.getByRole('button', { name: 'Copy position of impact' }).click();
  await page.getByText(/^Copied: /).waitFor();
  const { final_state } = await ask(service.address, 'simulate', { ...example('target_1'), angle_unit: 'rad' });
  const degrees = (angle: number) => ((angle * 180) / Math.PI).toFixed(5);
  const place = `${degrees(final_state.geodetic_latitude)}, ${degrees(final_state.longitude)}`;
  expect(await page.evaluate(() => navigator.clipboard.readText())).toBe(place);
  await page.close();
});

it('the validation table says that every reference check passes', async () => {
  const { page } = await on('target_1');
  await page.getByRole('button', { name: 'Validation' }).click();
  await page.getByText(/All \d+ reference checks pass\./).waitFor();
  expect(await page.getByRole('dialog').locator('tbody tr').count()).toBeGreaterThan(100);
  await page.keyboard.press('Escape');
  await expect.poll(() => page.getByRole('dialog').count()).toBe(0);
  await page.close();
});
