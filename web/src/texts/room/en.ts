export const roomEn = {
  watching: "Watching",
  unknown: "It is not known at present who is watching.",
  you: "you",
  role: {
    operator: "operator",
    supervisor: "supervisor",
    viewer: "viewer",
    screen: "theatre screen",
    camera: "camera",
  },
  line: { good: "good connection", slow: "slow connection", silent: "not answering" },
};

export type RoomTexts = typeof roomEn;
