declare module 'virtual:schema' {
  /** Of each schema of a case its properties, with what the OpenAPI document says of them. */
  const schema: Record<string, Record<string, import('./form/schema').Property>>;
  export default schema;
}

declare module 'virtual:examples' {
  const examples: { group: string; title: string; case: import('./api').Case; notes: string }[];
  export default examples;
}
