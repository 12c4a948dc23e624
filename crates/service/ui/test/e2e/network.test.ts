import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, beforeEach, describe, expect, it } from 'vitest';
import { toFragment } from '../../src/link';
import { example, figure, launch, open, type Service, serve } from './browser';
import { type Network, networkTo } from './proxy';

let service: Service;
let browser: Browser;
let network: Network;

beforeAll(async () => {
  [service, browser] = await Promise.all([serve(), launch()]);
  network = await networkTo(service.address);
});

beforeEach(() => {
  Object.assign(network, { delay: 0, refuse: () => null });
});

afterAll(async () => {
  await browser?.close();
  await network?.stop();
  await service?.stop();
});

async function on(name: string): Promise<Page> {
  return (await open(browser, `${network.address}/${await toFragment(example(name))}`)).page;
}

/** How often the flight that is shown has changed since the last drag began. */
function changes(page: Page): Promise<number> {
  return page.evaluate(() => (window as unknown as { changes: number }).changes);
}

/** Drags the slider of the mass to and fro until `isEnough`. */
async function dragged(page: Page, isEnough: () => boolean | Promise<boolean>): Promise<void> {
  const box = await page.locator('#slider-vehicle-mass').boundingBox();
  if (!box) throw new Error('the slider has no place');
  await page.locator('[data-figure="Time"]').evaluate((element) => {
    const counted = window as unknown as { changes: number };
    counted.changes = 0;
    const count = () => {
      counted.changes += 1;
    };
    new MutationObserver(count).observe(element, { characterData: true, childList: true, subtree: true });
  });
  const middle = box.y + box.height / 2;
  await page.mouse.move(box.x + box.width / 3, middle);
  await page.mouse.down();
  for (let moves = 0; !(await isEnough()); moves += 1) {
    await page.mouse.move(box.x + box.width * (0.35 + 0.3 * Math.sin(moves / 20)), middle);
    await page.waitForTimeout(15);
  }
  await page.mouse.up();
}

/** Drags the slider of the mass for so long, ms. */
async function draggedFor(page: Page, duration: number): Promise<void> {
  const end = performance.now() + duration;
  await dragged(page, () => performance.now() > end);
}

describe('over a network of 120 ms there and back', () => {
  it('a slider that keeps moving moves the flight with every answer, and no request is given up', async () => {
    const page = await on('target_2');
    const failed: string[] = [];
    page.on('requestfailed', (request) => failed.push(request.url()));
    network.delay = 120;
    let [asked, answered, waiting] = [0, 0, 0];
    page.on('request', () => {
      asked += 1;
      waiting = Math.max(waiting, asked - answered);
    });
    page.on('requestfinished', () => {
      answered += 1;
    });
    let changed = 0;
    await dragged(page, async () => {
      changed = await changes(page);
      return changed >= 12;
    });
    // The last answers may not be on the page yet, and two may come between two frames of a busy machine.
    expect(changed).toBeGreaterThan(answered / 2);
    expect(waiting).toBeLessThanOrEqual(2);
    expect(failed).toEqual([]);
    await page.close();
  });

  it('the flight is that of the last place of the slider', async () => {
    const page = await on('target_2');
    network.delay = 120;
    await draggedFor(page, 500);
    await page.waitForTimeout(1000);
    const shown = await figure(page, 'Time');
    await page.reload();
    await expect.poll(() => figure(page, 'Time')).toBe(shown);
    await page.close();
  });
});

it('a slider asks for fewer rows than the flight has at rest, and for no column that is not drawn', async () => {
  const page = await on('lifting_capsule');
  const asked: { output: { columns?: string[]; samples_per_step: number } }[] = [];
  page.on('request', (request) => {
    if (request.url().endsWith('/simulate')) asked.push(request.postDataJSON());
  });
  const fewest = () => Math.min(...asked.map((request) => request.output.samples_per_step));
  const most = () => Math.max(...asked.map((request) => request.output.samples_per_step));
  // Where other work slows the browser down, moves may lie so far apart that the slider rests at each.
  const isSlower = async () => {
    await draggedFor(page, 1000);
    return fewest() < most();
  };
  await expect.poll(isSlower, { timeout: 15_000 }).toBe(true);
  // The flight at rest comes last, when the page has had the time.
  await expect.poll(() => (asked.at(-1)?.output.samples_per_step ?? 0) > fewest(), { timeout: 10_000 }).toBe(true);
  const resting = asked.at(-1)?.output;
  const moving = asked.sort((a, b) => a.output.samples_per_step - b.output.samples_per_step)[0];
  expect(moving?.output.samples_per_step).toBeLessThan(resting?.samples_per_step as number);
  expect(moving?.output.columns).toContain('load_factor');
  expect(moving?.output.columns).not.toContain('inertial_speed');
  expect(resting?.columns).toEqual(moving?.output.columns);
  const bytes = async (output: object) => {
    const response = await fetch(`${service.address}/simulate`, {
      method: 'POST',
      headers: { 'content-type': 'application/json', 'accept-encoding': 'identity' },
      body: JSON.stringify({ ...moving, output }),
    });
    return (await response.arrayBuffer()).byteLength;
  };
  const all = await bytes({ samples_per_step: resting?.samples_per_step });
  expect(await bytes(moving?.output as object)).toBeLessThan(all / 4);
  await page.close();
});

it('a case that comes to rest while its flight is under way is flown with all its rows after it', async () => {
  const page = await on('lifting_capsule');
  const asked: number[] = [];
  page.on('request', (request) => {
    if (request.url().endsWith('/simulate')) asked.push(request.postDataJSON().output.samples_per_step);
  });
  // The answer to the second request, the first of a case that moves, comes long after the rest began. Where other work slows the browser down,
  // moves may lie so far apart that the slider rests at each.
  network.delay = 1500;
  await dragged(page, () => asked.length >= 2);
  await expect.poll(() => asked.at(-1), { timeout: 15_000 }).toBe(Math.max(...asked));
  await page.close();
});

it('a quantity whose plot is added is asked for, and is in flights that were pinned before', async () => {
  const page = await on('lifting_capsule');
  await page.getByRole('button', { name: 'Pin this flight' }).click();
  await page.locator('#field\\/vehicle\\/mass').fill('7000');
  await page.waitForTimeout(800);
  await page.getByLabel('Add a plot').selectOption('inertial_speed');
  const card = page.locator('.plot-card', { hasText: 'Inertial speed' });
  await page.locator('#instant').focus();
  await page.keyboard.press('ArrowRight');
  await expect.poll(() => card.locator('.reading').allTextContents()).toEqual([expect.stringMatching(/^79/), expect.stringMatching(/^79/)]);
  await page.close();
});

it.each([
  ['is busy', { status: 503, headers: { 'retry-after': '1' } }, 'Service busy'],
  ['is asked too often', { status: 429, headers: { 'retry-after': '1' } }, 'Service busy'],
  ['is away for a moment', { status: 502 }, 'Service not responding'],
])('where the service %s the last flight stays, and the next comes by itself', async (_, refusal, told) => {
  const page = await on('target_2');
  const before = await figure(page, 'Time');
  let refused = 0;
  network.refuse = () => (refused++ < 2 ? refusal : null);
  const began = performance.now();
  await page.locator('#field\\/vehicle\\/mass').fill('750');
  await page.getByText(told).waitFor();
  expect(await page.locator('.cards.stale, .notice').count()).toBe(0);
  expect(await figure(page, 'Time')).toBe(before);
  await expect.poll(() => figure(page, 'Time'), { timeout: 10_000 }).not.toBe(before);
  expect(performance.now() - began).toBeGreaterThan(1900);
  expect(await page.locator('.waiting').textContent()).toBe('');
  await page.close();
});
