import { afterEach, expect, test, vi } from "vitest";
import { storeTourLeft, wasTourLeft } from "./storedTour";

afterEach(() => {
  vi.unstubAllGlobals();
});

test("a tour that was left is remembered in this browser", () => {
  const stored = new Map<string, string>();
  vi.stubGlobal("localStorage", {
    getItem: (key: string) => stored.get(key) ?? null,
    setItem: (key: string, value: string) => stored.set(key, value),
  });
  expect(wasTourLeft()).toBe(false);
  storeTourLeft();
  expect(wasTourLeft()).toBe(true);
});

test("without storage the tour is offered on each visit", () => {
  vi.stubGlobal("localStorage", {
    getItem: () => {
      throw new DOMException("", "SecurityError");
    },
    setItem: () => {
      throw new DOMException("", "SecurityError");
    },
  });
  storeTourLeft();
  expect(wasTourLeft()).toBe(false);
});
