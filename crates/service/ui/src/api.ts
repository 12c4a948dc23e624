import type { components } from './generated/api';

type Schemas = components['schemas'];
export type Case = Schemas['SimulateRequest'];
export type State = Schemas['State'];
/** A state, or a launch. */
export type InitialState = Schemas['InitialState'];
export type Answer = Schemas['SimulateResponse'];
export type Columns = Schemas['Columns'];
export type Row = Schemas['Row'];
export type Conversion = Schemas['ConvertResponse'];
export type Solution = Schemas['Solution'];
export type Theory = Schemas['AnalyticResponse'];
export type Problem = Schemas['Problem'];
export type Warning = Schemas['Warning'];
export type { Schemas };

/** An answer of the service that is none: its problem document. */
export class ProblemError extends Error {
  constructor(
    readonly problem: Problem,
    /** After how many seconds to ask again, where the service says so. */
    readonly retryAfter: number | null = null,
  ) {
    super(problem.detail);
  }
}

/** The address of a path of the service, beside which the page lies. */
export function address(path: string): string {
  return new URL(path, document.baseURI).href;
}

/** Flies a case. */
export function simulate(body: unknown, signal?: AbortSignal): Promise<Answer> {
  return post('simulate', body, signal);
}

/** Turns a state into every coordinate system. */
export function convert(body: unknown, signal?: AbortSignal): Promise<Conversion> {
  return post('convert', body, signal);
}

/** A closed-form theory beside the flight. */
export function analytic(body: unknown, signal?: AbortSignal): Promise<Theory> {
  return post('analytic', body, signal);
}

/** The sites that a case may name. */
export async function sites(): Promise<Schemas['ListedSite'][]> {
  const response = await fetch(address('sites'));
  if (!response.ok) throw new ProblemError(await problemOf(response));
  return ((await response.json()) as Schemas['Sites']).sites;
}

/** What a path makes of a body, as it comes. */
export async function download(path: string, body: unknown): Promise<Blob> {
  return (await send(path, body)).blob();
}

async function post<T>(path: string, body: unknown, signal?: AbortSignal): Promise<T> {
  return (await send(path, body, signal)).json();
}

async function send(path: string, body: unknown, signal?: AbortSignal): Promise<Response> {
  const response = await fetch(address(path), {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: JSON.stringify(body),
    signal: signal ?? null,
  });
  if (!response.ok) {
    const seconds = Number.parseFloat(response.headers.get('retry-after') ?? '');
    throw new ProblemError(await problemOf(response), Number.isFinite(seconds) ? Math.max(seconds, 0) : null);
  }
  return response;
}

/** The problem document; what a proxy in between may have said instead, in its form. */
async function problemOf(response: Response): Promise<Problem> {
  const body = await response.json().catch(() => null);
  return body?.detail
    ? body
    : {
        type: 'about:blank',
        title: response.statusText,
        status: response.status,
        detail: `The service returned status ${response.status}.`,
      };
}
