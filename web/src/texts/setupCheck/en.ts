export const setupCheckEn = {
  title: "Planned screw",
  /** `place` is one of the two below. */
  registration:
    "{vertebra} {side}, screw of {diameter} mm: error {place} at least {error} mm (95 %), {tolerance} mm to the wall.",
  landmarks:
    "{vertebra} {side}, screw of {diameter} mm: with the planned landmarks and an exact tool, an error of {error} mm (95 %) is expected {place}, {tolerance} mm to the wall.",
  entry: "at the entry",
  isthmus: "at the isthmus",
  suffices: "The set-up suffices for this screw.",
  insufficient: "The set-up does not suffice: every image would be SET-UP INSUFFICIENT.",
  remedies: "What would help, each alone:",
  remedy: {
    more_landmarks: "{landmarks} landmarks, spread as these and none mistaken: {error} mm",
    exact_tool: "A tool with exact tip and axis: {error} mm",
    thinner_screw: "Screw of {diameter} mm: {tolerance} mm to the wall",
    surface_sweep: "A surface sweep: its error is known after it",
  },
  enough: "enough at best",
  notEnough: "not enough",
};

export type SetupCheckTexts = typeof setupCheckEn;
