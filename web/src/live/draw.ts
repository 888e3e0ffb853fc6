/** Draws the picture of a frame and reports when it is decoded; false if it cannot be drawn. */
export type Draw = (
  jpeg: Uint8Array<ArrayBuffer>,
  isCurrent: () => boolean,
  onDecoded: () => void,
) => Promise<boolean>;

/** Result of a frame: whether it is displayed, and how long that took. */
export interface DisplayResult {
  isDisplayed: boolean;
  showingMs: number;
}
