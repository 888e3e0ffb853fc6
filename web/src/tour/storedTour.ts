// Whether the tour was left or ended in this browser; it is then no longer offered by itself.

const STORAGE_KEY = "coaxial.tour";
const LEFT = "left";

export function wasTourLeft(): boolean {
  try {
    return localStorage.getItem(STORAGE_KEY) === LEFT;
  } catch {
    // Storage is unavailable: same as on the first visit.
    return false;
  }
}

export function storeTourLeft(): void {
  try {
    localStorage.setItem(STORAGE_KEY, LEFT);
  } catch {
    // It is then left for this visit only.
  }
}
