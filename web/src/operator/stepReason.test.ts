import { expect, test } from "vitest";
import type { Procedure, Step } from "../app/procedure";
import { de } from "../texts/de";
import { en } from "../texts/en";
import { stepReason } from "./stepReason";

const step = (name: Step["step"], changes: Partial<Step> = {}): Step => ({
  step: name,
  state: "done",
  message: "the server's reason",
  remedy: "The server's remedy.",
  numbers: {},
  document_id: "d1",
  allowed: true,
  missing_cosignature: null,
  ...changes,
});

const procedure = (changes: Partial<Procedure> = {}, ...others: Step[]): Procedure => ({
  case_id: "c1",
  case_name: "Case",
  steps: others,
  next_step: "navigate",
  may_navigate: false,
  confirmation: null,
  setup_check: null,
  recording: null,
  ...changes,
});

const SERVERS = { message: "The server's reason.", remedy: "The server's remedy.", lang: "en" };

test("English is the server's own", () => {
  expect(stepReason(step("camera", { state: "missing" }), procedure(), en)).toEqual(SERVERS);
});

test.each([
  [step("camera", { state: "missing" }), "Die Kamera ist nicht kalibriert."],
  [step("camera", { document_id: null }), "Die Kalibrierung der Kamera stammt aus den Einstellungen."],
  [
    step("camera", { state: "failed", numbers: { maximum_error_mm: 1.5, limit_mm: 1 } }),
    "Die Kamera misst einen bekannten Abstand um 1.50 mm falsch, erlaubt 1.00 mm.",
  ],
  [step("tool", { state: "missing" }), "Die Achse des Instruments ist unbekannt."],
  [step("tool", { state: "missing", document_id: null }), "Es ist kein Instrument kalibriert."],
  [step("plan", { state: "missing" }), "Es ist kein Kanal zum Bohren gewählt."],
  [step("register", { numbers: { method: "needles" } }), "Registriert. Verfahren: Drei Nadeln."],
  [
    step("check", { numbers: { landmark: "A", distance_mm: 0.41, max_mm: 2, age_min: 3 } }),
    "Spitze auf A: 0.41 mm vom geplanten Ort, erlaubt 2.00 mm.",
  ],
  [
    step("check", { state: "due", numbers: { landmark: "A", distance_mm: 0.4, max_mm: 2, age_min: 31 } }),
    "Die Prüfung an A ist 31 min alt.",
  ],
])("%j reads %s", (one, message) => {
  expect(stepReason(one, procedure({}, one), de)).toMatchObject({ message, lang: "de" });
});

test("without a case every step has the same reason", () => {
  const reason = stepReason(step("check", { state: "missing" }), procedure({ case_id: null }), de);
  expect(reason.message).toBe("Es ist kein Fall geöffnet.");
});

test("a check without a registration is not called missing", () => {
  const check = step("check", { state: "missing" });
  const lost = step("register", { state: "out_of_date" });
  expect(stepReason(check, procedure({}, lost), de).message).toContain("keine gültige Registrierung");
  expect(stepReason(check, procedure({}, step("register")), de).message).toContain("noch nicht");
});

test("navigation names the first step that it waits for", () => {
  const navigate = step("navigate", { state: "missing" });
  const steps = [step("camera"), step("tool", { state: "missing" }), step("check", { state: "missing" })];
  expect(stepReason(navigate, procedure({}, ...steps, navigate), de).message).toContain("Instrument");
});

test.each([
  ["what is out of date", step("plan", { state: "out_of_date" })],
  [
    "the age of a check after the clock was set back",
    step("check", { state: "due", numbers: { landmark: "A", age_min: -2 } }),
  ],
  ["an unknown method", step("register", { numbers: { method: "new" } })],
  ["tools, whose names only the server lists", step("tool")],
])("%s is stated in the server's English", (_, one) => {
  expect(stepReason(one, procedure({}, one), de)).toEqual(SERVERS);
});
