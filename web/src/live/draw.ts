/** Draws the picture of a frame; false when it cannot be drawn. Reports when it is decoded. */
export type Draw = (
  jpeg: Uint8Array<ArrayBuffer>,
  isCurrent: () => boolean,
  onDecoded: () => void,
) => Promise<boolean>;

/** What became of a frame: whether it stands, and how long the page needed for that. */
export interface DisplayResult {
  isDisplayed: boolean;
  showingMs: number;
}
