import type { components } from './generated/api';

type Schemas = components['schemas'];
export type Goal = Schemas['Goal'];
export type VariedNumber = Schemas['VariedNumber'];
export type TargetRequest = Schemas['TargetRequest'];
export type Target = Schemas['TargetResponse'];
export type CorridorRequest = Schemas['CorridorRequest'];
export type Limit = CorridorRequest['limits'][number];
export type Corridor = Schemas['CorridorResponse'];
export type FootprintRequest = Schemas['FootprintRequest'];
export type Footprint = Schemas['FootprintResponse'];
/** The accuracy of a footprint, m, and the flights that it may take, where they are not the defaults. */
export interface FootprintOptions {
  resolution?: number;
  flights?: number;
}

/** What the page asks of a flight, beside the case: one link has both. */
export interface Asked {
  /** The numbers that are free. */
  vary?: VariedNumber[];
  /** What is to be achieved. */
  achieve?: Goal[];
  /** The limits of a corridor or a footprint that are not goals. */
  limits?: Limit[];
  /** Whether the ground that flights reach is asked for; `false` where the fields of a footprint are there and it is not. */
  footprint?: boolean | FootprintOptions;
  /** The pointers of the numbers that have a slider; those that matter, where there is no list. */
  sliders?: string[];
}

/** A case, and what is asked of it. */
export type Case = Schemas['SimulateRequest'] & Asked;
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

/** Finds numbers of a case with which its flight achieves goals. */
export function target(body: TargetRequest, signal?: AbortSignal): Promise<Target> {
  return post('target', body, signal);
}

/** Finds the values of a number with which flights keep limits. */
export function corridor(body: CorridorRequest, signal?: AbortSignal): Promise<Corridor> {
  return post('corridor', body, signal);
}

/** Finds the ground that flights reach when numbers of a case vary. */
export function footprint(body: FootprintRequest, signal?: AbortSignal): Promise<Footprint> {
  return post('footprint', body, signal);
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
