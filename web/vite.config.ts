import react from "@vitejs/plugin-react";
import { defineConfig } from "vitest/config";

export default defineConfig({
  plugins: [react()],
  build: { target: "es2023", sourcemap: false, chunkSizeWarningLimit: 700, assetsInlineLimit: 0 },
  // For work on the page alone: the server runs beside it on its usual port.
  server: {
    host: "127.0.0.1",
    proxy: Object.fromEntries(
      ["/api", "/ws", "/video", "/scene", "/health"].map((door) => [
        door,
        { target: `http://127.0.0.1:${process.env["COAXIAL_PORT"] ?? "8000"}`, ws: true },
      ]),
    ),
  },
  test: {
    environment: "node",
    // Their contrast is tested.
    css: { include: [/tokens\.css/] },
    include: ["src/**/*.test.ts", "src/**/*.test.tsx"],
    setupFiles: "src/testLocation.ts",
    // Test files share one copy of the modules, because importing React and Mantine for each took four fifths of the
    // time. So a module under test keeps no state, and a file that replaces a global restores it.
    pool: "threads",
    isolate: false,
    // Only for a test that hangs, because other programs may delay a test.
    testTimeout: 60_000,
  },
});
