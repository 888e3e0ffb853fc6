import { expect, test } from "vitest";
import { afterRedo, afterUndo, historyKey, lastStep, NO_HISTORY, read, withChange } from "./undo";

/** Version 1 was the document "one"; two changes here made 2 ("two") and 3 ("three"). */
const CHANGED_TWICE = withChange(withChange(NO_HISTORY, "one", 2), "two", 3);

test("changes are taken back one after the other, each as a new version", () => {
  expect(lastStep(CHANGED_TWICE.done, 3)?.documentId).toBe("two");
  let history = afterUndo(CHANGED_TWICE, "three", 4);
  expect(lastStep(history.done, 4)?.documentId).toBe("one");
  history = afterUndo(history, "two again", 5);
  expect(lastStep(history.done, 5)).toBeNull();
});

test("undone changes are made again in reverse order, and can be undone again", () => {
  let history = afterUndo(afterUndo(CHANGED_TWICE, "three", 4), "two again", 5);
  expect(lastStep(history.undone, 5)?.documentId).toBe("two again");
  history = afterRedo(history, "one again", 6);
  expect(lastStep(history.undone, 6)?.documentId).toBe("three");
  expect(lastStep(history.done, 6)?.documentId).toBe("one again");
  history = afterRedo(history, "two, a third time", 7);
  expect(lastStep(history.undone, 7)).toBeNull();
  expect(lastStep(history.done, 7)?.documentId).toBe("two, a third time");
  expect(lastStep(afterUndo(history, "three again", 8).done, 8)?.documentId).toBe("one again");
});

test("after another change nothing is made again", () => {
  expect(withChange(afterUndo(CHANGED_TWICE, "three", 4), "two again", 5).undone).toEqual([]);
});

test("what somebody else changed since is neither taken back nor overwritten", () => {
  expect(lastStep(withChange(NO_HISTORY, "one", 2).done, 3)).toBeNull();
  expect(lastStep(afterUndo(CHANGED_TWICE, "three", 4).undone, 5)).toBeNull();
});

test("the first change leads back to no plan", () => {
  expect(lastStep(withChange(NO_HISTORY, null, 1).done, 1)).toEqual({ documentId: null, madeVersion: 1 });
});

test("thirty changes are remembered", () => {
  let history = read(null);
  for (let version = 1; version < 50; version += 1) history = withChange(history, `d${version}`, version);
  expect(history.done).toHaveLength(30);
  expect(lastStep(history.done, 49)?.documentId).toBe("d49");
});

test.each([["not JSON"], ["{}"], ["[]"], ["7"], [null]])("what is stored as %s is no change", (text) => {
  expect(read(text)).toEqual(NO_HISTORY);
});

test("a stored history is read", () => {
  expect(read(JSON.stringify(CHANGED_TWICE))).toEqual(CHANGED_TWICE);
});

const NONE = { ctrlKey: false, metaKey: false, shiftKey: false, altKey: false };

test.each([
  ["z", { ctrlKey: true }, "undo"],
  ["z", { metaKey: true }, "undo"],
  ["Z", { ctrlKey: true, shiftKey: true }, "redo"],
  ["y", { ctrlKey: true }, "redo"],
  ["z", {}, null],
  ["y", { ctrlKey: true, altKey: true }, null],
  ["a", { ctrlKey: true }, null],
] as const)("%s with %j is %s", (key, modifiers, meaning) => {
  expect(historyKey({ ...NONE, ...modifiers, key })).toBe(meaning);
});
