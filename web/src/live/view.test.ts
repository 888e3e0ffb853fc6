import { expect, test } from "vitest";
import { alarms } from "./alarmBuilders";
import { Live } from "./live";
import { keyOf } from "./view";

test("the texts change with the alarms of the shown image, whatever the newest message has", () => {
  const view = new Live(() => 0).update();
  const shown = { ...view, alarms: alarms({ revision: 1 }) };
  expect(keyOf({ ...shown, alarms: alarms({ revision: 2 }) })).not.toBe(keyOf(shown));
});
