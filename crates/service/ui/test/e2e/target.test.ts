import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';
import { browser, example, open, prepare, service, shows } from './browser';

prepare();

const caseOf = async (page: Page) => (await fromFragment(new URL(page.url()).hash)) as Case;
const panelOf = (page: Page) => page.getByRole('region', { name: 'Target', exact: true });
const said = (page: Page) => panelOf(page).getByRole('status').textContent();

/** The case of the example with a burn that lands it where its own burn does, and nothing asked of it. */
function capsule(): Case {
  const { vary: _, achieve: __, ...flight } = example('target');
  return flight;
}

it('a burn and a bank angle are found for a place that is dragged on the map, and taken', async () => {
  const { page, complaints } = await open(browser, `${service.address}/${await toFragment(capsule())}`);
  await page.getByRole('button', { name: 'Target', exact: true }).click();
  const panel = panelOf(page);
  // One free number by its mark, from fixed over slider to free, another one by the panel.
  await page.locator('summary', { hasText: /^Events/ }).click();
  const mark = page.getByRole('button', { name: /^Role of (Rises through|Rises above)/ }).first();
  await mark.click();
  await mark.click();
  await panel.getByLabel('Free a number').selectOption({ label: 'Bank angle' });
  await expect
    .poll(async () => (await caseOf(page)).vary?.map(({ pointer }) => pointer), { timeout: 10_000 })
    .toEqual(['/events/0/when/rises_through', '/control/bank_angle']);
  await expect.poll(() => said(page), { timeout: 30_000 }).toMatch(/^\d solution/);

  const map = page.locator('canvas.world');
  await map.scrollIntoViewIfNeeded();
  await panel.getByText('Searching …').waitFor({ state: 'hidden' });
  // What the search has found moves the map down.
  const boxOf = async () => (await map.boundingBox()) as { x: number; y: number; width: number; height: number };
  let box = await boxOf();
  const moved = async () => {
    const last = box.y;
    await page.waitForTimeout(500);
    box = await boxOf();
    return box.y - last;
  };
  await expect.poll(moved, { timeout: 10_000 }).toBe(0);
  const site = async () => {
    const [goal] = (await caseOf(page)).achieve ?? [];
    return (goal as { site: { longitude: number; geodetic_latitude: number } }).site;
  };
  const before = await site();
  const x = box.x + ((before.longitude + 180) / 360) * box.width;
  const y = box.y + ((90 - before.geodetic_latitude) / 180) * box.height;
  const earlier = await said(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 4, y, { steps: 4 });
  await page.mouse.up();
  await expect.poll(async () => (await site()).longitude, { timeout: 10_000 }).toBeCloseTo(before.longitude + (4 / box.width) * 360, 1);

  expect((await site()).geodetic_latitude).toBeCloseTo(before.geodetic_latitude, 0);
  // The place as it is now, not as it was before or on the way: each search has taken another time.
  await expect.poll(() => said(page), { timeout: 30_000 }).not.toBe(earlier);
  await expect.poll(() => said(page), { timeout: 30_000 }).toMatch(/^\d solution/);
  await panel.getByText('Searching …').waitFor({ state: 'hidden' });
  await panel.getByRole('button', { name: 'Take solution 1 into the case' }).click();
  const { longitude, geodetic_latitude: latitude } = await site();
  await shows(page, 'Final position', `${latitude.toFixed(5)}°, ${longitude.toFixed(5)}°`);
  expect(complaints).toEqual([]);
  await page.close();
});

it('says how near it comes where a place cannot be reached, and shows what is asked in a link again', async () => {
  const tree = capsule();
  const asked: Case = {
    ...tree,
    vary: [{ pointer: '/control/bank_angle', between: [0, 90] }],
    achieve: [{ site: { longitude: 67, geodetic_latitude: 40 }, tolerance: 100 }],
  };
  const { page } = await open(browser, `${service.address}/${await toFragment(asked)}`);
  await expect.poll(() => said(page), { timeout: 30_000 }).toMatch(/^Cannot reach: .*km (short|long|to the (left|right))/);
  await panelOf(page).getByRole('button', { name: 'Take the nearest into the case' }).waitFor();
  expect(await panelOf(page).getByLabel('Target latitude').inputValue()).toBe('40');
  await page.close();
});

it('has the corridor of its one free number on the slider', async () => {
  const corridor = example('corridor') as Case & { vary: unknown };
  const { page } = await open(browser, service.address);
  const buffer = Buffer.from(JSON.stringify(corridor));
  await page.locator('#file').setInputFiles({ name: 'corridor.json', mimeType: 'application/json', buffer });
  const band = page.getByRole('img', { name: 'Flight-path angle: 1 allowed range' });
  await band.waitFor({ timeout: 30_000 });
  const share = await band.locator('span').evaluate((span) => span.clientWidth / (span.parentElement?.clientWidth ?? 1));
  const sentence = (await panelOf(page).getByText('that keeps the limits').textContent()) ?? '';
  const [from, to] = [...sentence.replaceAll('−', '-').matchAll(/-\d+(\.\d+)?/g)].map(([value]) => Number(value)) as [number, number];
  expect(from).toBeLessThan(to);
  await page.getByText('Green: this case within the corridor').first().waitFor();
  // The slider goes over 6°.
  expect(share).toBeCloseTo((to - from) / 6, 1);
  await page.close();
});
