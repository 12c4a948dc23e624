/** What the OpenAPI document says of a property. */
export interface Property {
  title?: string;
  description?: string;
  default?: unknown;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  /** Its unit; `angle` where it is an angle, in the unit of the case. */
  'x-unit'?: string;
  type?: string;
  const?: unknown;
  enum?: string[];
  items?: Property;
  anyOf?: Property[];
  minItems?: number;
  maxItems?: number;
  $ref?: string;
}

/** What the OpenAPI document says of an object, of a union of objects, or of words. */
export interface Schema {
  properties?: Record<string, Property>;
  required?: string[];
  /** Fields of which one is given: exactly one, or at most one. */
  alternatives: string[][];
  /** The kinds of a union, each with its label and its schema; by the discriminator, their words. */
  variants?: { title: string; $ref: string }[];
  discriminator?: { mapping: Record<string, string> };
  enum?: string[];
  const?: string;
  /** A label for each word. */
  'x-titles'?: Record<string, string>;
  /** The unit of each word that names a quantity; `angle` as with fields. */
  'x-units'?: Record<string, string>;
}

/** The name of the schema to which a reference leads. */
export function nameOf(reference: string): string {
  return reference.slice(reference.lastIndexOf('/') + 1);
}
