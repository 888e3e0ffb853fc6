import { useSyncExternalStore, type ReactNode } from "react";
import { usePainter } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";
import { EXAMPLES, type ExampleName } from "./examples";
import { guidingSound } from "./guidingSound";

const EXAMPLE_MS = 2500;
const NAMES = Object.keys(EXAMPLES) as ExampleName[];

/** Turns the guiding sound on, sets its volume, and plays examples of it. */
export function GuidingSoundSettings(): ReactNode {
  const texts = useTexts().theatre.guiding;
  const { isOn, failed, volume } = useSyncExternalStore(guidingSound.subscribe, guidingSound.current);
  usePainter((view) => {
    guidingSound.paint(view);
  });
  return (
    <section className="guiding-sound" aria-labelledby="guiding-sound">
      <h2 id="guiding-sound">{texts.title}</h2>
      <p className="quiet">{texts.hint}</p>
      <button
        type="button"
        aria-pressed={isOn}
        data-testid="guiding-sound"
        onClick={() => {
          if (isOn) guidingSound.turnOff();
          else guidingSound.turnOn();
        }}
      >
        {isOn ? texts.turnOff : texts.turnOn}
      </button>
      {failed && <p role="alert">{texts.failed}</p>}
      {isOn && (
        <>
          <label>
            {texts.volume}{" "}
            <input
              type="range"
              min={0}
              max={1}
              step={0.05}
              value={volume}
              onChange={(event) => {
                guidingSound.setVolume(event.target.valueAsNumber);
              }}
            />
          </label>
          <ul>
            {NAMES.map((name) => (
              <li key={name}>
                <Example name={name} />
              </li>
            ))}
          </ul>
        </>
      )}
    </section>
  );
}

function Example({ name }: { name: ExampleName }): ReactNode {
  const texts = useTexts().theatre.guiding;
  return (
    <button
      type="button"
      data-testid={`guiding-${name}`}
      onClick={() => {
        guidingSound.playExample(EXAMPLES[name], performance.now() + EXAMPLE_MS);
      }}
    >
      {texts.example[name]}
    </button>
  );
}
