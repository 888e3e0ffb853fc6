export const operatorEn = {
  steps: "Steps of the procedure",
  skip: "Skip to the step",
  next: "Next step",
  at: "{at} of {all}",
  now: "next",
  locked: "later",
  page: {
    case: "Case",
    camera: "Camera",
    tool: "Tool",
    plan: "Plan",
    register: "Registration",
    check: "Check",
    navigate: "Navigation",
    recordings: "Recordings",
    report: "Report",
    people: "People",
  },
  ready: "ready",
  ofRehearsal: "rehearsal's own",
  fewLandmarks: {
    one: "The plan has {count} landmark. Registration with landmarks needs at least {min}; with three needles, none.",
    other:
      "The plan has {count} landmarks. Registration with landmarks needs at least {min}; with three needles, none.",
  },
  state: { missing: "to do", out_of_date: "out of date", failed: "failed", due: "due again", done: "done" },
};

export type OperatorTexts = typeof operatorEn;
