import { type ChildProcess, spawn } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { type Browser, type BrowserContextOptions, chromium, type Page } from 'playwright-core';
import { afterAll, beforeAll, expect } from 'vitest';
import type { Case } from '../../src/api';

export const ROOT = new URL('../../../../../', import.meta.url);
const PROGRAM = process.env.REENTRY ?? new URL('target/release/reentry', ROOT).pathname;
const CHROMIUM = process.env.CHROMIUM ?? new URL('target/chromium/run', ROOT).pathname;

/** The program, on a port of its own. */
export interface Service {
  address: string;
  stop(): Promise<void>;
}

/** Starts the program, and waits until it says where it listens. */
export async function serve(): Promise<Service> {
  const program: ChildProcess = spawn(PROGRAM, ['serve', '--listen', '127.0.0.1:0'], { stdio: ['ignore', 'pipe', 'pipe'] });
  const address = await new Promise<string>((resolve, reject) => {
    program.once('error', reject);
    program.once('exit', (code) => reject(new Error(`${PROGRAM} ended with ${code}`)));
    for (const stream of [program.stdout, program.stderr]) {
      if (!stream) continue;
      createInterface(stream).on('line', (line) => {
        const found = /127\.0\.0\.1:\d+/.exec(line);
        if (found) resolve(`http://${found[0]}`);
      });
    }
  });
  return {
    address,
    async stop() {
      program.kill('SIGTERM');
      if (program.exitCode === null) await once(program, 'exit');
    },
  };
}

/** The Chromium that `tests/setup` found, or another one. */
export function launch(): Promise<Browser> {
  return chromium.launch({ executablePath: CHROMIUM, args: ['--no-sandbox', '--disable-quic'] });
}

/** The service and the browser of a file of tests that has called `prepare`. */
export let service: Service;
export let browser: Browser;

/** Starts the service and the browser before the tests of a file, and ends them afterwards. */
export function prepare(): void {
  beforeAll(async () => {
    [service, browser] = await Promise.all([serve(), launch()]);
  });
  afterAll(async () => {
    await browser?.close();
    await service?.stop();
  });
}

/** A page of the service, and what it asked for and complained of meanwhile. */
export interface Opened {
  page: Page;
  requests: string[];
  complaints: string[];
}

/** Opens the page with a flight, from the address of a case if there is one. */
export async function open(browser: Browser, url: string, options: BrowserContextOptions = {}): Promise<Opened> {
  const context = await browser.newContext({
    viewport: { width: 1440, height: 1000 },
    // Whatever that of the machine is: in that of POSIX the headless shell has a name for it that its own `Intl` refuses.
    locale: 'en-US',
    permissions: ['clipboard-read', 'clipboard-write'],
    ...options,
  });
  const page = await context.newPage();
  const opened: Opened = { page, requests: [], complaints: [] };
  page.on('request', (request) => opened.requests.push(request.url()));
  page.on('pageerror', (error) => opened.complaints.push(error.message));
  page.on('console', (message) => {
    // An answer of 422 is what an invalid case gets, and the browser tells it.
    if (message.type() === 'error' && !message.text().includes('422')) opened.complaints.push(message.text());
  });
  await page.goto(url);
  await page.locator('.card').first().waitFor({ state: 'attached' });
  await page.waitForURL(/#case=/);
  return opened;
}

/** A figure of the flight as it is shown, once the page is at rest. */
export async function figure(page: Page, label: string): Promise<string> {
  return (await page.locator(`[data-figure="${label}"]`).textContent()) ?? '';
}

/** Waits until a figure is shown. */
export async function shows(page: Page, label: string, value: string): Promise<void> {
  await expect.poll(() => figure(page, label), { timeout: 10_000 }).toBe(value);
}

/** What the service answers a case. */
// biome-ignore lint/suspicious/noExplicitAny: the tests read single fields of it
export async function ask(address: string, path: string, body: unknown): Promise<any> {
  const response = await fetch(`${address}/${path}`, {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: JSON.stringify(body),
  });
  return response.json();
}

/** A case of the repository. */
export function example(name: string): Case {
  return JSON.parse(readFileSync(new URL(`openapi/examples/${name}.json`, ROOT), 'utf8'));
}

/** The source of a package, to run in the page. */
export function source(path: string): string {
  return readFileSync(new URL(`../../node_modules/${path}`, import.meta.url), 'utf8');
}
