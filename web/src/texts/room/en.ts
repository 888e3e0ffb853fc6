export const roomEn = {
  watching: "Watching",
  unknown: "It is not known at present who is watching.",
  thisComputer: "this computer",
  you: "you",
  role: {
    operator: "operator",
    supervisor: "supervisor",
    viewer: "viewer",
    screen: "theatre screen",
    camera: "camera",
  },
  what: "Who sees what",
  freshness: { old: "picture too old", hidden: "page in the background", unknown: "unknown whether live" },
  figures: "Figures only",
  upTo: "up to # ms old",
  line: { good: "good connection", slow: "slow connection", silent: "not answering" },
};

export type RoomTexts = typeof roomEn;
