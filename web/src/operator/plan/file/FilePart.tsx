import { Alert, Button } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { postPlanImport } from "../../../api";
import { Rejection } from "../../../rest/client";
import { useTexts } from "../../../texts/TextsContext";
import { FileButtons } from "../ct/FileButtons";
import { usePlanning } from "../state/PlanContext";

/** Export and import of the plan as a file. */
export function FilePart(): ReactNode {
  const texts = useTexts().plan.file;
  const { plan, vertebrae, change, busy, forget, rejection } = usePlanning();
  const [content, setContent] = useState<{ name: string; text: string } | null>(null);
  const hasMarkups = vertebrae.some(({ channels, landmarks }) => channels.length + landmarks.length > 0);
  const isOfOtherCt = rejection?.problem.code === "PLAN_OF_ANOTHER_CT";
  const read = (text: string, forOtherCt: boolean): void => {
    void change((by) => {
      const query = { ...by, for_other_ct: forOtherCt };
      // The text is JSON already.
      return postPlanImport({ query, body: text, bodySerializer: null });
    });
  };
  return (
    <>
      <h3>{texts.title}</h3>
      <p>{texts.hint}</p>
      {plan === null ? (
        <p className="soft">{texts.none}</p>
      ) : (
        <Button size="xl" fullWidth component="a" href="/api/plan/export" download data-testid="export">
          {texts.out}
        </Button>
      )}
      {plan !== null && plan.heading.current && hasMarkups && (
        <Button
          size="xl"
          fullWidth
          variant="default"
          component="a"
          href="/api/plan/markups"
          download
          data-testid="export-markups"
        >
          {texts.outForSlicer}
        </Button>
      )}
      <FileButtons
        texts={{ file: texts.in }}
        accept=".json,application/json"
        disabled={busy}
        onFiles={(files) => {
          const [file] = files;
          if (file === undefined) return;
          forget();
          void file.text().then((text) => {
            setContent({ name: file.name, text });
            read(text, false);
          });
        }}
      />
      {plan !== null && <p className="soft">{texts.replaces}</p>}
      {isOfOtherCt && content !== null && (
        <Alert className="consequence" title={texts.otherCt}>
          <p>{texts.otherCtHint}</p>
          <Button
            size="lg"
            mt="sm"
            disabled={busy}
            onClick={() => {
              read(content.text, true);
            }}
          >
            {texts.takeAllTheSame}
          </Button>
        </Alert>
      )}
      {rejection instanceof Rejection && !isOfOtherCt && content !== null && (
        <p className="soft">{content.name}</p>
      )}
    </>
  );
}
