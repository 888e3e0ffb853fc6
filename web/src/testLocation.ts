// Runs before each test file: modules read the page's origin while they are imported, and Node has no page.
Object.defineProperty(globalThis, "location", { value: new URL("http://127.0.0.1/"), configurable: true });
