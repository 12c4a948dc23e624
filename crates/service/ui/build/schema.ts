import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';
import type { Property, Schema } from '../src/form/schema.ts';

const DOCUMENT = new URL('../../../../openapi/openapi.json', import.meta.url);

/** What a form needs of the schema of a value. */
const OF_PROPERTY = [
  'title',
  'description',
  'default',
  'minimum',
  'maximum',
  'exclusiveMinimum',
  'exclusiveMaximum',
  'x-unit',
  'type',
  'const',
  'enum',
  'items',
  'minItems',
  'maxItems',
  '$ref',
];

/** What a form needs of a schema with a name, beside its properties. */
const OF_SCHEMA = ['enum', 'const', 'x-titles', 'x-units', 'required', 'discriminator'];

type Json = Record<string, unknown>;

/** The schemas of the OpenAPI document of which a case is made, as `virtual:schema`: what a form shows of them, and no more. */
export function schema(): Plugin {
  return {
    name: 'schema',
    resolveId: (id) => (id === 'virtual:schema' ? '\0virtual:schema' : undefined),
    load(id) {
      if (id !== '\0virtual:schema') return;
      const schemas = JSON.parse(readFileSync(DOCUMENT, 'utf8')).components.schemas;
      const reached = reachable(schemas, 'SimulateRequest');
      return `export default ${JSON.stringify(Object.fromEntries(reached.map((name) => [name, shown(schemas[name])])))}`;
    },
  };
}

/** The names of a schema and of all that it refers to. */
function reachable(schemas: Record<string, Json>, root: string): string[] {
  const names = new Set([root]);
  for (const name of names) {
    for (const [, found] of JSON.stringify(schemas[name]).matchAll(/#\/components\/schemas\/(\w+)/g)) names.add(found as string);
  }
  return [...names];
}

function shown(schema: Json): Schema {
  const properties = Object.entries((schema.properties ?? {}) as Record<string, Json>);
  const variants = (schema.discriminator ? schema.oneOf : []) as Json[];
  return {
    ...kept(schema, OF_SCHEMA),
    ...(schema.properties
      ? { properties: Object.fromEntries(properties.map(([name, property]) => [name, kept(property, OF_PROPERTY)])) }
      : {}),
    ...(variants.length > 0 ? { variants: variants.map((variant) => kept(variant, ['title', '$ref'])) } : {}),
    alternatives: alternatives(schema),
  } as Schema;
}

function kept(schema: Json, keys: string[]): Property {
  return Object.fromEntries(keys.filter((key) => key in schema).map((key) => [key, schema[key]]));
}

/** The fields of an object of which one is given: exactly one, or at most one. */
function alternatives(schema: Json): string[][] {
  const ofConditions = [...((schema.allOf ?? []) as Json[]), schema.then as Json].filter((condition) => condition !== undefined);
  return ofConditions.flatMap((condition) => {
    const exactly = ((condition.oneOf ?? []) as { required: string[] }[]).flatMap(({ required }) => required);
    const atMost = (condition.not as { required?: string[] } | undefined)?.required ?? [];
    const inner = condition.then ? alternatives({ allOf: [condition.then] }) : [];
    const deeper = condition.allOf ? alternatives({ allOf: condition.allOf }) : [];
    return [exactly, atMost, ...inner, ...deeper].filter((names) => names.length > 1);
  });
}
