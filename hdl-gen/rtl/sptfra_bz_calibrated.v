// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Bz with a calibration in RAM: counts become pascals by the bank that acts at a frame's first beat
// (sptfra_calibrate), a tare listens, taxels that the bank says are dead are replaced (sptfra_replace), Bz takes
// pascals. Thresholds and version of that bank go into the frame's context.

`default_nettype none

module sptfra_bz_calibrated #(
    // As of sptfra_bz, in pascals
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter WAYS = 4,
    parameter DATA_BITS = 27,
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    parameter DEAD = 0,
    parameter WEIGHT_SHIFT = 16,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    parameter EXPECTED_STAGES = 0,
    // As of sptfra_calibrate
    parameter SAMPLE = 0,
    parameter OFFSET_BITS = 29,
    parameter COUNT_SHIFT = 14,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter EXPECTED_CALIBRATION = 0,
    // Dead taxels that a bank can have replaced, and what does at power-up: see sptfra_dead_bank
    parameter REPLACEABLE = 0,
    parameter [3:0] REPLACED_COUNT = 4'd0,
    parameter [4:0] REPLACED_SHIFT = 5'd17,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)-1:0] REPLACED_TAXELS
        = {16*((REPLACEABLE != 0) ? REPLACEABLE : 1){1'b0}},
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter TAXELS = COLUMNS * ROWS,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter ELEMENTS = (WAYS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter COMMAND_BITS = TAXEL_WIDTH + OFFSET_BITS + 31 + ((REPLACEABLE != 0) ? 56 : 0),
    parameter RESULT_BITS = OFFSET_BITS + 28 + ((REPLACEABLE != 0) ? 34 : 0)
) (
    input  wire clock,
    input  wire reset,
    // Samples in
    input  wire [SAMPLE_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // As of sptfra_bz
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [WAYS*DATA_BITS-1:0] write_data,
    input  wire cean_idle,
    input  wire direction_room,
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced,
    output wire frame_ready,
    input  wire frame_start,
    input  wire frame_release,
    // Calibration: {active, generation, contact, noise}
    input  wire [67:0] calibration_acting,
    output wire calibration_old_in_use,
    // {write gain, write offset, bank, taxel, gain, offset}, and the words there: {gain, offset}; in front of each,
    // where dead taxels stand in the banks, what sptfra_dead_bank has of that
    input  wire [COMMAND_BITS-1:0] bank_command,
    output wire [RESULT_BITS-1:0] bank_words,
    // {run, log2 of frames, taxel}; {finished, restless, bad frame, mean}
    input  wire [TAXEL_WIDTH+4:0] tare_command,
    output wire [29:0] tare_result,
    // What a frame begins with: see sptfra_frame_context
    output wire frame_calibrates,
    output wire [70:0] frame_calibration // {contact, noise, version, replaced taxels}
);

    // Word of a bank with which dead taxels begin, and the cycles that a frame takes for them
    localparam [31:0] FIRST_OF_DEAD = 2 * TAXELS + 2;
    localparam REPLACING = (REPLACEABLE != 0) ? TAXELS + 6 : 0;

    wire active, write_gain, write_offset, tare_run, frame_begins;
    wire [7:0] generation;
    wire [31:0] contact;
    wire [26:0] noise;
    wire [TAXEL_WIDTH:0] bank_address;
    wire [27:0] gain_in;
    wire [OFFSET_BITS-1:0] offset_in;
    wire [3:0] tare_log2, replaced_count;
    wire [TAXEL_WIDTH-1:0] tare_taxel, reading_taxel_8, reading_taxel;

    assign {active, generation, contact, noise} = calibration_acting;
    assign frame_calibrates = frame_begins;
    assign frame_calibration = {contact, noise, generation, replaced_count};
    assign {write_gain, write_offset, bank_address, gain_in, offset_in} = bank_command[TAXEL_WIDTH+OFFSET_BITS+30:0];
    assign {tare_run, tare_log2, tare_taxel} = tare_command;

    // ---- Counts to pascals
    wire [31:0] pascals_tdata;
    wire pascals_tlast, pascals_tvalid, pascals_tready;
    wire bank_held, hold;
    wire reading_valid, reading_marked, reading_last, reading_bad, reading_not_finite, reading_advance;
    wire signed [26:0] reading, back_stress;
    wire back_valid, back_last, back_not_finite;

    sptfra_calibrate #(
        .TAXELS          (TAXELS),
        .SAMPLE          (SAMPLE),
        .OFFSET_BITS     (OFFSET_BITS),
        .COUNT_SHIFT     (COUNT_SHIFT),
        .FULL_SCALE      (FULL_SCALE),
        .STRESS_BOUND    (STRESS_BOUND),
        .STRESS_LSB      (-NUMBER_SHIFT),
        .ROM_DIR         (ROM_DIR),
        .ROM_NAME        (ROM_NAME),
        .EXPECTED_STAGES ((EXPECTED_CALIBRATION != 0) ? EXPECTED_CALIBRATION - REPLACING : 0)
    ) calibrate (
        .clock             (clock),
        .reset             (reset),
        .s_tdata           (s_tdata),
        .s_tlast           (s_tlast),
        .s_tvalid          (s_tvalid),
        .s_tready          (s_tready),
        .m_tdata           (pascals_tdata),
        .m_tlast           (pascals_tlast),
        .m_tvalid          (pascals_tvalid),
        .m_tready          (pascals_tready),
        .active            (active),
        .old_in_use        (calibration_old_in_use),
        .frame_begins      (frame_begins),
        .bank_held         (bank_held),
        .hold              (hold),
        .write_gain        (write_gain),
        .write_offset      (write_offset),
        .address           (bank_address),
        .write_gain_data   (gain_in),
        .write_offset_data (offset_in),
        .gain              (bank_words[OFFSET_BITS+27:OFFSET_BITS]),
        .offset            (bank_words[OFFSET_BITS-1:0]),
        .tare_run          (tare_run),
        .reading_valid     (reading_valid),
        .reading_marked    (reading_marked),
        .reading_last      (reading_last),
        .reading_taxel_8   (reading_taxel_8),
        .reading_taxel     (reading_taxel),
        .reading           (reading),
        .reading_bad       (reading_bad),
        .reading_nan       (reading_not_finite),
        .reading_advance   (reading_advance),
        .back_valid        (back_valid),
        .back_last         (back_last),
        .back_stress       (back_stress),
        .back_not_finite   (back_not_finite)
    );

    // ---- Dead taxels, of the bank's map
    wire [29:0] bz_replaced;

    generate
        if (REPLACEABLE != 0) begin : gen_replace
            wire [18*REPLACEABLE-1:0] weights;
            wire [3:0] count;
            wire [4:0] weight_shift;
            wire [16*REPLACEABLE-1:0] taxels;

            sptfra_dead_bank #(
                .TAXELS       (TAXELS),
                .REPLACEABLE  (REPLACEABLE),
                .FIRST        (FIRST_OF_DEAD[15:0]),
                .COUNT        (REPLACED_COUNT),
                .WEIGHT_SHIFT (REPLACED_SHIFT),
                .NUMBERS      (REPLACED_TAXELS),
                .ROM_DIR      (ROM_DIR),
                .ROM_NAME     (ROM_NAME)
            ) dead_bank (
                .clock        (clock),
                .command      (bank_command[COMMAND_BITS-1 -: 56]),
                .result       (bank_words[RESULT_BITS-1 -: 34]),
                .active       (active),
                .acting_count (replaced_count),
                .read_enable  (reading_advance),
                .read_bank    (bank_held),
                .read_taxel   (reading_taxel_8),
                .read_weights (weights),
                .read_count   (count),
                .read_shift   (weight_shift),
                .read_numbers (taxels)
            );

            sptfra_replace #(
                .TAXELS       (TAXELS),
                .REPLACEABLE  (REPLACEABLE),
                .STRESS_BOUND (STRESS_BOUND)
            ) replace (
                .clock          (clock),
                .reset          (reset),
                .advance        (reading_advance),
                .begins         (frame_begins),
                .hold           (hold),
                .in_valid       (reading_valid),
                .in_last        (reading_last),
                .in_stress      (reading),
                .in_not_finite  (reading_not_finite),
                .weights_ahead  (weights),
                .count          (count),
                .weight_shift   (weight_shift),
                .taxels         (taxels),
                .out_valid      (back_valid),
                .out_last       (back_last),
                .out_stress     (back_stress),
                .out_not_finite (back_not_finite),
                .replaced       (frame_replaced),
                .replaced_take  (frame_done)
            );

            wire _unused_replaced = &{1'b0, bz_replaced};
        end else begin : gen_as_read
            assign hold = 1'b0;
            assign back_valid = reading_valid;
            assign back_last = reading_last;
            assign back_stress = reading;
            assign back_not_finite = reading_not_finite;
            assign replaced_count = 4'd0;
            assign frame_replaced = bz_replaced;
            wire _unused_map = &{1'b0, bank_held, FIRST_OF_DEAD, REPLACED_COUNT, REPLACED_SHIFT, REPLACED_TAXELS};
        end
    endgenerate

    sptfra_tare #(
        .TAXELS (TAXELS)
    ) tare (
        .clock       (clock),
        .reset       (reset),
        .run         (tare_run),
        .log2_frames (tare_log2),
        .most_spread (noise),
        .advance     (reading_advance),
        .valid       (reading_valid),
        .marked      (reading_marked),
        .last        (reading_last),
        .bad         (reading_bad),
        .taxel_ahead (reading_taxel_8),
        .taxel       (reading_taxel),
        .reading     (reading),
        .finished    (tare_result[29]),
        .restless    (tare_result[28]),
        .bad_frame   (tare_result[27]),
        .mean_taxel  (tare_taxel),
        .mean        (tare_result[26:0])
    );

    // ---- Pascals to the lanes
    sptfra_bz #(
        .COLUMNS         (COLUMNS),
        .ROWS            (ROWS),
        .WAYS            (WAYS),
        .DATA_BITS       (DATA_BITS),
        .NUMBER_SHIFT    (NUMBER_SHIFT),
        .NUMBER_BOUND    (NUMBER_BOUND),
        .DEAD            (DEAD),
        .WEIGHT_SHIFT    (WEIGHT_SHIFT),
        .STRESS_BOUND    (STRESS_BOUND),
        .ROM_DIR         (ROM_DIR),
        .ROM_NAME        (ROM_NAME),
        .EXPECTED_STAGES (EXPECTED_STAGES)
    ) bz (
        .clock            (clock),
        .reset            (reset),
        .s_tdata          (pascals_tdata),
        .s_tlast          (pascals_tlast),
        .s_tvalid         (pascals_tvalid),
        .s_tready         (pascals_tready),
        .write_valid      (write_valid),
        .write_ready      (write_ready),
        .write_bank       (write_bank),
        .write_row        (write_row),
        .write_data       (write_data),
        .cean_idle        (cean_idle),
        .direction_room   (direction_room),
        .stress_valid     (stress_valid),
        .stress           (stress),
        .frame_done       (frame_done),
        .frame_saturated  (frame_saturated),
        .frame_not_finite (frame_not_finite),
        .frame_bad_length (frame_bad_length),
        .frame_replaced   (bz_replaced),
        .frame_ready      (frame_ready),
        .frame_start      (frame_start),
        .frame_release    (frame_release)
    );

endmodule

`default_nettype wire
