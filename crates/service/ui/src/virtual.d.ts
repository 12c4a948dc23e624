declare module 'virtual:schema' {
  /** The schemas of which a case is made, as the OpenAPI document has them. */
  const schema: Record<string, import('./form/schema').Schema>;
  export default schema;
}

declare module 'virtual:examples' {
  const examples: { group: string; title: string; case: import('./api').Case; notes: string }[];
  export default examples;
}
