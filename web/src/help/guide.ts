// Where the user guide explains a page. `tests/architecture/test_house_guide.py` checks that each place exists.
export const GUIDE_PLACES = {
  signIn: "access/#signing-in",
  case: "first-procedure/#the-steps",
  camera: "camera/#calibrate",
  tool: "marker/#the-tool-behind-it",
  plan: "planning/",
  register: "registration/#methods",
  check: "registration/",
  navigate: "#what-the-numbers-mean",
  recordings: "recording/",
  report: "recording/#course-of-the-drilling",
  people: "access/",
  theatre: "theatre/",
  supervisor: "#what-the-numbers-mean",
  phone: "camera/#a-phone-as-camera",
} as const;

export type GuidePlace = keyof typeof GUIDE_PLACES;

/** Address of the guide at this place. */
export function guideAddress(place: GuidePlace): string {
  return `/docs/${GUIDE_PLACES[place]}`;
}
