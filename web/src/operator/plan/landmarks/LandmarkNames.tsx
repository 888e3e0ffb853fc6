import { Button, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { Dialog } from "../../../panes/Dialog";
import { useTexts } from "../../../texts/TextsContext";

interface LandmarkNamesProps {
  opened: boolean;
  usedNames: readonly string[];
  onClose: () => void;
  onName: (name: string) => void;
}

/** Name of a landmark: a usual one by a tap, or typed. */
export function LandmarkNames({ opened, usedNames, onClose, onName }: LandmarkNamesProps): ReactNode {
  const texts = useTexts().plan.landmarks;
  const [typed, setTyped] = useState("");
  const name = typed.trim();
  return (
    <Dialog
      opened={opened}
      onClose={onClose}
      title={texts.which}
      size="lg"
      closeButtonProps={{ size: 48, "aria-label": texts.close }}
    >
      <div className="landmark-names">
        {Object.values(texts.usual)
          .filter((one) => !usedNames.includes(one))
          .map((one) => (
            <Button
              key={one}
              size="lg"
              variant="default"
              onClick={() => {
                onName(one);
              }}
            >
              {one}
            </Button>
          ))}
      </div>
      <form
        className="landmark-typed"
        onSubmit={(event) => {
          event.preventDefault();
          if (name === "" || usedNames.includes(name)) return;
          setTyped("");
          onName(name);
        }}
      >
        <TextInput
          size="lg"
          label={texts.other}
          maxLength={60}
          value={typed}
          onChange={(event) => {
            setTyped(event.currentTarget.value);
          }}
        />
        <Button size="lg" type="submit" disabled={name === "" || usedNames.includes(name)}>
          {texts.take}
        </Button>
      </form>
    </Dialog>
  );
}
