import { expect, test } from "vitest";
import { isLoopback } from "./loopback";

test.each([
  ["localhost", true],
  ["127.0.0.1", true],
  ["[::1]", true],
  ["theatre-3.hospital.example", false],
  ["192.168.1.27", false],
  ["localhost.example", false],
])("the server of a page from %s is on the same machine: %s", (hostname, is) => {
  expect(isLoopback(hostname)).toBe(is);
});
