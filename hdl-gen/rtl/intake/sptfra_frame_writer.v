// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame writer of Bz: corrects and averages a frame, writes it to the lanes, scaled and folded, and streams it to CeAn.
//
// Beat to CeAn: as of sptfra_taxel_stream. Beat to write: 5 cycles, with SCALED see sptfra_frame_scale; with SMOOTHING
// both wait for the frame's end, see sptfra_smoothing. All later by what sptfra_frame_corrections takes.

`default_nettype none

module sptfra_frame_writer #(
    // Taxels in x and y, and of a beat
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter SAMPLES = 1,
    // 4: folded into parity components; 1: as they are
    parameter CHANNELS = 4,
    // Bits of a stress, 27 at most, and of what the lanes read: as many, or 29 and more where taxels are folded
    parameter DATA_BITS = 27,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // 1: each frame has a scale of its own
    parameter SCALED = 0,
    // Places for dead taxels, 0 for none: see sptfra_replace
    parameter REPLACEABLE = 0,
    parameter MAPPED = 0,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)+15:0] REPLACED = 0,
    // Crosstalk, creep: see sptfra_frame_corrections
    parameter [59:0] CROSSTALK = 60'd0,
    parameter [45:0] CREEP = 46'd0,
    // {stress, fraction bits of the factor, factor} of a step that restarts the average, 0: none; see sptfra_smoothing
    parameter [49:0] SMOOTHING = 50'd0,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter TAXELS = COLUMNS * ROWS,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter PLACES = (REPLACEABLE != 0) ? REPLACEABLE : 1,
    parameter ELEMENTS = (CHANNELS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // Beats of stresses
    input  wire in_takes, // it is of the frame
    input  wire in_ends, // the frame ends with it, or with what follows a frame that is too long
    input  wire in_bad_length,
    input  wire [27*SAMPLES-1:0] in_stresses,
    input  wire [SAMPLES-1:0] in_saturated,
    input  wire [SAMPLES-1:0] in_not_finite,
    // Of dead taxels: see sptfra_replace
    input  wire [TAXEL_WIDTH-1:0] taxel_ahead,
    input  wire [34*PLACES+8:0] map,
    input  wire [3:0] smoothing, // see sptfra_smoothing
    output wire replace_busy, // from a frame's last beat in to its last stress out
    output wire busy, // a frame's last stress has come, and not all that is made of it
    // Operand memories, component 0 in the lowest bits
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [CHANNELS*DATA_BITS-1:0] write_data,
    // To CeAn: each stress, then the frame's flags
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced, // sum of the magnitudes that took a dead taxel's place
    // The frame's power of two, for one cycle, before it is ready
    output wire scaled,
    output wire [4:0] exponent,
    output wire [25:0] smoothed, // {one cycle, variance}: see sptfra_smoothing
    // Banks
    input  wire frame_opens, // a frame begins to come in
    output wire frame_ready, // a whole frame waits
    input  wire frame_start, // the lanes begin with it
    input  wire frame_release, // its bank is free again
    output wire bank_free
);

    localparam BEATS = (TAXELS + SAMPLES - 1) / SAMPLES;
    localparam BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1;
    localparam COUNT_WIDTH = $clog2(BEATS + 1);
    localparam STRESS_BITS = (DATA_BITS < 27) ? DATA_BITS : 27;

    if ((SAMPLES != 1) && (SAMPLES != 2) && (SAMPLES != 4) && (SAMPLES != 8)) begin : gen_check_samples
        sptfra_error_samples_of_a_beat_must_be_1_2_4_or_8 invalid ();
    end
    if ((DATA_BITS < 16) || (DATA_BITS > ((CHANNELS == 4) ? 35 : 27))) begin : gen_check_data
        sptfra_error_data_bits_must_be_16_to_27_or_to_35_where_taxels_are_folded invalid ();
    end

    // ---- Dead taxels, crosstalk, creep
    wire corrections_busy, corrected_takes, corrected_ends, corrected_bad_length, corrected_replaced;
    wire [27*SAMPLES-1:0] corrected;
    wire [SAMPLES-1:0] corrected_saturated, corrected_not_finite;

    sptfra_frame_corrections #(
        .COLUMNS           (COLUMNS),
        .ROWS              (ROWS),
        .SAMPLES           (SAMPLES),
        .STRESS_BOUND      (STRESS_BOUND),
        .REPLACEABLE       (REPLACEABLE),
        .MAPPED            (MAPPED),
        .REPLACED          (REPLACED),
        .CROSSTALK         (CROSSTALK),
        .CREEP             (CREEP),
        .ROM_DIR           (ROM_DIR),
        .ROM_NAME          (ROM_NAME)
    ) corrections (
        .clock          (clock),
        .reset          (reset),
        .in_takes       (in_takes),
        .in_ends        (in_ends),
        .in_bad_length  (in_bad_length),
        .in_stresses    (in_stresses),
        .in_saturated   (in_saturated),
        .in_not_finite  (in_not_finite),
        .taxel_ahead    (taxel_ahead),
        .map            (map),
        .replace_busy   (replace_busy),
        .busy           (corrections_busy),
        .takes          (corrected_takes),
        .ends           (corrected_ends),
        .bad_length     (corrected_bad_length),
        .stresses       (corrected),
        .saturated      (corrected_saturated),
        .not_finite     (corrected_not_finite),
        .replaced       (corrected_replaced)
    );

    // ---- Smoothing
    localparam CANDIDATES = (SMOOTHING != 0) ? 2 : 1; // stresses, and averages with them
    reg ended; // the frame's last beat is there
    reg [COUNT_WIDTH-1:0] written; // beats that are there
    wire smoothing_busy, takes, ends, bad_length_now, replaced, settled, averaged, over;
    wire [27*SAMPLES*CANDIDATES-1:0] stresses; // candidate by candidate
    wire [SAMPLES-1:0] saturated, not_finite;

    if (SMOOTHING != 0) begin : gen_smoothed
        sptfra_smoothing #(
            .TAXELS   (TAXELS),
            .SAMPLES  (SAMPLES),
            .FRACTION (SMOOTHING[22:17]),
            .FACTOR   (SMOOTHING[16:0]),
            .LARGEST  (SMOOTHING[49:23])
        ) smoothing_of_frames (
            .clock          (clock),
            .reset          (reset),
            .opens          (frame_opens),
            .rate           (smoothing),
            .in_takes       (corrected_takes),
            .in_ends        (corrected_ends),
            .in_bad_length  (corrected_bad_length),
            .in_stresses    (corrected),
            .in_flags       ({corrected_saturated, corrected_not_finite, corrected_replaced}),
            .busy           (smoothing_busy),
            .out_takes      (takes),
            .out_ends       (ends),
            .out_bad_length (bad_length_now),
            .out_stresses   (stresses[27*SAMPLES-1:0]),
            .out_averages   (stresses[27*SAMPLES*CANDIDATES-1 -: 27*SAMPLES]),
            .out_flags      ({saturated, not_finite, replaced}),
            .decided        (settled),
            .averaged       (averaged),
            .over           (over),
            .known          (smoothed[25]),
            .variance       (smoothed[24:0])
        );
    end else begin : gen_as_they_come
        assign {takes, ends, bad_length_now, replaced}
            = {corrected_takes, corrected_ends, corrected_bad_length, corrected_replaced};
        assign {stresses, saturated, not_finite} = {corrected, corrected_saturated, corrected_not_finite};
        assign {smoothing_busy, settled, averaged} = {1'b0, ended, 1'b0};
        assign smoothed = 26'd0;
        wire _unused_smoothing = &{1'b0, smoothing};
    end

    // ---- To CeAn, taxel by taxel
    localparam WORD_BITS = 27 * CANDIDATES + 1; // of a taxel: whether it was replaced, its candidates
    wire [WORD_BITS*SAMPLES-1:0] words;
    wire [WORD_BITS-1:0] word;
    wire [STRESS_BITS*SAMPLES*CANDIDATES-1:0] narrow_stresses; // to the lanes, sample by sample
    genvar sample;
    genvar candidate;

    assign stress = averaged ? word[27*(CANDIDATES-1) +: 27] : word[26:0];

    for (sample = 0; sample < SAMPLES; sample = sample + 1) begin : gen_words
        assign words[WORD_BITS*(sample+1)-1] = replaced;

        for (candidate = 0; candidate < CANDIDATES; candidate = candidate + 1) begin : gen_candidates
            wire [26:0] of_sample = stresses[27*(SAMPLES*candidate+sample) +: 27];

            assign words[WORD_BITS*sample+27*candidate +: 27] = of_sample;
            assign narrow_stresses[STRESS_BITS*(CANDIDATES*sample+candidate) +: STRESS_BITS]
                = of_sample[STRESS_BITS-1:0];
        end
    end

    sptfra_taxel_stream #(
        .TAXELS  (TAXELS),
        .SAMPLES (SAMPLES),
        .KEPT    ((SMOOTHING != 0) ? 1 : 0),
        .WIDTH   (WORD_BITS)
    ) taxel_stream (
        .clock        (clock),
        .reset        (reset),
        .takes        (takes),
        .beat         (written),
        .stresses     (words),
        .ends         (ends),
        .whole        (settled),
        .restart      (over),
        .stress_valid (stress_valid),
        .stress       (word),
        .done         (frame_done)
    );

    // ---- The frame as it comes
    reg bad_length;
    reg seen_saturated;
    reg seen_not_finite;
    reg [29:0] replaced_before; // without the stress that is shown
    wire [26:0] magnitude = stress[26] ? -stress : stress;
    wire folded;
    reg flags_sent;
    wire [31:0] written_wide = {{(32-COUNT_WIDTH){1'b0}}, written};

    assign over = folded && (frame_done || flags_sent); // the lanes have it all, and CeAn its flags
    assign busy = ended || corrections_busy || smoothing_busy;
    assign frame_saturated = seen_saturated || (takes && (saturated != {SAMPLES{1'b0}}));
    assign frame_not_finite = seen_not_finite || (takes && (not_finite != {SAMPLES{1'b0}}));
    assign frame_bad_length = ends ? bad_length_now : bad_length;
    assign frame_replaced = replaced_before + ((stress_valid && word[WORD_BITS-1]) ? {3'd0, magnitude} : 30'd0);

    always @(posedge clock) begin
        seen_saturated <= frame_saturated;
        seen_not_finite <= frame_not_finite;
        bad_length <= frame_bad_length;
        replaced_before <= frame_replaced;
        if (takes) begin
            written <= written + 1'b1;
        end
        if (ends) begin
            ended <= 1'b1;
        end
        if (frame_done) begin
            flags_sent <= 1'b1;
        end
        if (reset || over) begin
            ended <= 1'b0;
            flags_sent <= 1'b0;
            written <= {COUNT_WIDTH{1'b0}};
        end
        if (reset || frame_done) begin
            seen_saturated <= 1'b0;
            seen_not_finite <= 1'b0;
            replaced_before <= 30'd0;
        end
    end

    // ---- Scale
    wire whole; // the lanes may have all of the frame

    if (SCALED != 0) begin : gen_scale
        sptfra_frame_scale #(
            .SAMPLES      (SAMPLES),
            .CANDIDATES   (CANDIDATES),
            .STRESS_BOUND (STRESS_BOUND)
        ) scale (
            .clock      (clock),
            .reset      (reset),
            .beat_valid (takes),
            .stresses   (stresses),
            .ends       (ends),
            .bad_length (bad_length_now),
            .averaged   (averaged),
            .restart    (over),
            .whole      (whole),
            .scaled     (scaled),
            .exponent   (exponent)
        );
    end else begin : gen_full_scale
        assign whole = settled;
        assign scaled = 1'b0;
        assign exponent = 5'd0;
        wire _unused_bound = &{1'b0, STRESS_BOUND};
    end

    // ---- To the lanes, orbit by orbit
    wire frame_written;

    sptfra_fold #(
        .COLUMNS     (COLUMNS),
        .ROWS        (ROWS),
        .SAMPLES     (SAMPLES),
        .CANDIDATES  (CANDIDATES),
        .CHANNELS    (CHANNELS),
        .STRESS_BITS (STRESS_BITS),
        .DATA_BITS   (DATA_BITS),
        .SCALED      (SCALED)
    ) fold (
        .clock         (clock),
        .reset         (reset),
        .advance       (write_ready), // whether or not there is something to write
        .beat_valid    (takes),
        .beat          (written_wide[BEAT_WIDTH-1:0]),
        .stresses      (narrow_stresses),
        .averaged      (averaged),
        .written       (((SCALED != 0) || (SMOOTHING != 0)) ? {COUNT_WIDTH{1'b0}} : written),
        .whole         (whole),
        .exponent      (exponent),
        .folded        (folded),
        .restart       (over),
        .write_valid   (write_valid),
        .write_bank    (write_bank),
        .write_row     (write_row),
        .write_data    (write_data),
        .frame_written (frame_written)
    );

    // ---- Banks
    reg [1:0] banks_taken;
    reg [1:0] frames_waiting;

    assign bank_free = (banks_taken != 2'd2);
    assign frame_ready = (frames_waiting != 2'd0);

    always @(posedge clock) begin
        banks_taken <= banks_taken + {1'b0, frame_opens} - {1'b0, frame_release};
        frames_waiting <= frames_waiting + {1'b0, frame_written} - {1'b0, frame_start};
        if (reset) begin
            banks_taken <= 2'd0;
            frames_waiting <= 2'd0;
        end
    end

    wire _unused = &{1'b0, written_wide};

endmodule

`default_nettype wire
