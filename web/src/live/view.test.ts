import { expect, test } from "vitest";
import { alarms } from "./alarmBuilders";
import { message } from "./builders";
import { Live } from "./live";
import { keyOf } from "./view";

test("the texts change with the alarms of the newest message", () => {
  const view = new Live(() => 0).update();
  const at = (revision: number) => ({ ...view, newest: message({ alarms: alarms({ revision }) }) });
  expect(keyOf(at(2))).not.toBe(keyOf(at(1)));
  expect(keyOf(at(1))).toBe(keyOf(at(1)));
});
