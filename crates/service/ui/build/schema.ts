import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';

const DOCUMENT = new URL('../../../../openapi/openapi.json', import.meta.url);
const KEPT = ['description', 'default', 'minimum', 'maximum', 'exclusiveMinimum', 'exclusiveMaximum'];

interface Schema {
  properties?: Record<string, Record<string, unknown>>;
  description?: string;
}

/** The parts of the OpenAPI document that a form shows, as `virtual:schema`: of each property its description, default and bounds. */
export function schema(): Plugin {
  return {
    name: 'schema',
    resolveId: (id) => (id === 'virtual:schema' ? '\0virtual:schema' : undefined),
    load(id) {
      if (id !== '\0virtual:schema') return;
      const document = JSON.parse(readFileSync(DOCUMENT, 'utf8'));
      const reached = reachable(document.components.schemas, 'SimulateRequest');
      return `export default ${JSON.stringify(Object.fromEntries(reached.map((name) => [name, kept(document.components.schemas[name])])))}`;
    },
  };
}

/** The names of a schema and of all that it refers to. */
function reachable(schemas: Record<string, Schema>, root: string): string[] {
  const names = new Set([root]);
  for (const name of names) {
    for (const [, found] of JSON.stringify(schemas[name]).matchAll(/#\/components\/schemas\/(\w+)/g)) names.add(found as string);
  }
  return [...names];
}

function kept(schema: Schema): Record<string, unknown> {
  return Object.fromEntries(
    Object.entries(schema.properties ?? {}).map(([name, property]) => [
      name,
      Object.fromEntries(KEPT.filter((key) => key in property).map((key) => [key, property[key]])),
    ]),
  );
}
