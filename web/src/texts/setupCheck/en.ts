export const setupCheckEn = {
  title: "Planned screw",
  /** `place` is one of the two below. */
  registration:
    "{vertebra} {side}, screw of {diameter} mm: error {place} at least {error} mm (95 %), {tolerance} mm to the wall.",
  landmarks:
    "{vertebra} {side}, screw of {diameter} mm: with the planned landmarks, each touched to {sd} mm (1 SD per axis), and an exact tool, an error of {error} mm (95 %) is expected {place}, {tolerance} mm to the wall.",
  entry: "at the entry",
  isthmus: "at the isthmus",
  suffices: "The set-up is sufficient for this screw.",
  insufficient: {
    registration: "The set-up is not sufficient: every image would report SET-UP INSUFFICIENT.",
    landmarks:
      "This is not sufficient: images would report SET-UP INSUFFICIENT unless the touches are better than assumed.",
  },
  remedies: "Each of these helps on its own:",
  remedy: {
    more_landmarks: "{landmarks} landmarks, spread like these, none mistaken: {error} mm",
    exact_tool: "A tool with an exact tip and axis: {error} mm",
    thinner_screw: "Screw of {diameter} mm: {tolerance} mm to the wall",
    surface_sweep: "A surface sweep: the error is known only afterwards",
  },
  enough: "enough at best",
};

export type SetupCheckTexts = typeof setupCheckEn;
