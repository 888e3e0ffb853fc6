import { defineConfig } from "@hey-api/openapi-ts";

export default defineConfig({
  input: "openapi.json",
  output: {
    path: "src/api",
    // The files of its client, which no schema changes, are not written for `exactOptionalPropertyTypes`.
    header: ({ defaultValue, file }) => (file ? defaultValue : ["// @ts-nocheck", ...defaultValue]),
  },
  parser: {
    patch: {
      // Functions are named after method and address: `getCasesByCaseId`. The server's ids repeat the address.
      operations: (method, address, operation) => {
        operation.operationId = `${method} ${address.replace("/api/", "").replaceAll("{", "by ")}`;
      },
      // A field with a default is in each answer, and the page sends it.
      schemas: (_name, schema) => {
        const fields = Object.entries(schema.properties ?? {}) as [string, object][];
        const withDefault = fields.filter(([, field]) => "default" in field).map(([name]) => name);
        schema.required = [...new Set([...(schema.required ?? []), ...withDefault])];
      },
    },
  },
  plugins: [
    "@hey-api/typescript",
    // Each function resolves to the body of the answer, or throws (`src/rest/client.ts`).
    { name: "@hey-api/sdk", responseStyle: "data" },
    { name: "@hey-api/client-fetch", throwOnError: true },
  ],
});
