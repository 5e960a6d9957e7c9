// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Bz: takes frames of stresses or counts from the stream, checks them, and writes them as fixed point into one
// of two banks of the lanes' operand memories: taxel by taxel, or folded into parity classes.
//
// Beat to stress: 5 cycles, with counts 9; to the write, where taxels are folded, three more. One beat a cycle. Where
// taxels are dead, a frame is complete before its first stress goes on: see sptfra_dead_taxels.
// A frame is accepted while a bank is free and CeAn has finished the frame before. Frames of a wrong length are
// swallowed up to their TLAST and marked.

`default_nettype none

module sptfra_bz #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // 4: folded into parity classes; 1: as they are
    parameter WAYS = 4,
    // Bits of a stress, 27 at most, and of what the lanes read: as many, or 29 and more where taxels are folded
    parameter DATA_BITS = 27,
    // Exponent of the number's step, negated, and its largest magnitude, of the stress or of the counts; with PER_TAXEL
    // each taxel has an exponent of its own
    parameter NUMBER_SHIFT = 9,
    parameter [26:0] NUMBER_BOUND = 27'd51200000,
    // What a sample of the stream is, and whether it is a count: see sptfra_samples
    parameter SAMPLE = 0,
    parameter COUNTS = 0,
    parameter PER_TAXEL = 0,
    // Whether each taxel has an exponent of its own
    parameter EXPONENTS = 0,
    parameter signed [17:0] GAIN = 18'sd65536,
    parameter OFFSET_BITS = 27,
    parameter COUNT_SHIFT = 16,
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    // Curve between counts and stress, of 2^CURVE_LEVELS segments, if there is one: see sptfra_curve
    parameter CURVE_LEVELS = 0,
    parameter [27*(1<<CURVE_LEVELS)-1:0] CURVE_KNOTS = {27*(1<<CURVE_LEVELS){1'b1}},
    parameter signed [26:0] CURVE_FIRST = 27'sd0,
    parameter signed [26:0] CURVE_LAST = 27'sd33554431,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Taxels that take a weighted sum of the others, and the fraction bits of the weights
    parameter DEAD = 0,
    parameter WEIGHT_SHIFT = 16,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Cycles from a beat to its stress that the plan counts on; 0: any
    parameter EXPECTED_STAGES = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter ELEMENTS = (WAYS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // Stream in
    input  wire [SAMPLE_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Operand memories, class 0 in the lowest bits
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [WAYS*DATA_BITS-1:0] write_data,
    // To CeAn: each stress, then the frame's flags
    input  wire cean_idle,
    input  wire direction_room, // in CeAn, for another frame
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced, // sum of the magnitudes that took a dead taxel's place
    // Banks
    output wire frame_ready, // a whole frame waits
    input  wire frame_start, // the lanes begin with it
    input  wire frame_release // its bank is free again
);

    localparam TAXELS = COLUMNS * ROWS;
    localparam INDEX_WIDTH = $clog2(TAXELS + 1);
    localparam STRESS_BITS = (DATA_BITS < 27) ? DATA_BITS : 27;
    localparam NUMBER_STAGES = 5;
    localparam CURVE_STAGES = (CURVE_LEVELS != 0) ? NUMBER_STAGES + CURVE_LEVELS + 7 : NUMBER_STAGES;
    localparam STAGES = (COUNTS != 0) ? CURVE_STAGES + 4 : CURVE_STAGES;

    generate
        if ((COLUMNS < 2) || (ROWS < 2) || (COLUMNS > 64) || (ROWS > 64)) begin : gen_check_grid
            sptfra_error_columns_and_rows_must_be_2_to_64 invalid ();
        end
        if ((WAYS != 1) && (WAYS != 4)) begin : gen_check_ways
            sptfra_error_ways_must_be_1_or_4 invalid ();
        end
        if ((DATA_BITS < 16) || (DATA_BITS > ((WAYS == 4) ? 35 : 27))) begin : gen_check_data
            sptfra_error_data_bits_must_be_16_to_27_or_to_35_where_taxels_are_folded invalid ();
        end
        if ((EXPECTED_STAGES != 0) && (EXPECTED_STAGES != STAGES)) begin : gen_check_stages
            sptfra_error_the_plan_counts_on_other_stages invalid ();
        end
    endgenerate

    // ---- Which beats belong to a frame
    reg [INDEX_WIDTH-1:0] index; // of the next beat, stops at TAXELS
    reg in_frame;
    reg [1:0] banks_taken;
    wire pipe_busy;
    wire advance = write_ready; // whether or not there is something to write: a short way to the stream
    wire frame_written; // the frame is complete

    // A frame may begin: a register, so that the stream's ready has a short way. What it looks at changes to the worse
    // with a frame's first beat only
    reg may_open;
    assign s_tready = advance && (in_frame || may_open);
    wire accept = s_tvalid && s_tready;
    wire store = (index != TAXELS);

    always @(posedge clock) begin
        if (accept) begin
            in_frame <= !s_tlast;
            index <= s_tlast ? {INDEX_WIDTH{1'b0}} : store ? index + 1 : index;
        end
        may_open <= !accept && !pipe_busy && cean_idle && (banks_taken != 2'd2) && direction_room;
        if (reset) begin
            may_open <= 1'b1;
            in_frame <= 1'b0;
            index <= {INDEX_WIDTH{1'b0}};
        end
    end

    reg [STAGES:1] valid;
    reg [STAGES:1] stores;
    reg [STAGES:1] lasts;
    reg [STAGES:1] bad_lengths;
    wire dead_busy;

    assign pipe_busy = (valid != {STAGES{1'b0}}) || dead_busy;

    always @(posedge clock) begin
        if (advance) begin
            valid <= {valid[STAGES-1:1], accept};
            stores <= {stores[STAGES-1:1], store};
            lasts <= {lasts[STAGES-1:1], s_tlast};
            bad_lengths <= {bad_lengths[STAGES-1:1], index != TAXELS - 1};
        end
        if (reset) begin
            valid <= {STAGES{1'b0}};
        end
    end

    // ---- Samples to stress
    wire signed [26:0] read;
    wire read_saturated;
    wire read_not_finite;

    sptfra_samples #(
        .TAXELS       (TAXELS),
        .SAMPLE       (SAMPLE),
        .NUMBER_SHIFT (NUMBER_SHIFT),
        .NUMBER_BOUND (NUMBER_BOUND),
        .COUNTS       (COUNTS),
        .PER_TAXEL    (PER_TAXEL),
        .EXPONENTS    (EXPONENTS),
        .GAIN         (GAIN),
        .OFFSET_BITS  (OFFSET_BITS),
        .COUNT_SHIFT  (COUNT_SHIFT),
        .FULL_SCALE   (FULL_SCALE),
        .CURVE_LEVELS (CURVE_LEVELS),
        .CURVE_KNOTS  (CURVE_KNOTS),
        .CURVE_FIRST  (CURVE_FIRST),
        .CURVE_LAST   (CURVE_LAST),
        .STRESS_BOUND (STRESS_BOUND),
        .ROM_DIR      (ROM_DIR),
        .ROM_NAME     (ROM_NAME)
    ) samples (
        .clock      (clock),
        .reset      (reset),
        .advance    (advance),
        .accept     (accept),
        .sample     (s_tdata),
        .last       (s_tlast),
        .next_taxel (valid[CURVE_STAGES] && stores[CURVE_STAGES]),
        .frame_ends (valid[CURVE_STAGES] && lasts[CURVE_STAGES]),
        .stress     (read),
        .saturated  (read_saturated),
        .not_finite (read_not_finite)
    );

    // ---- Dead taxels
    wire signed [26:0] fixed;
    wire saturated;
    wire not_finite;
    wire whole_valid;
    wire whole_store;
    wire whole_last;
    wire whole_bad_length;

    generate
        if (DEAD != 0) begin : gen_dead
            sptfra_dead_taxels #(
                .TAXELS       (TAXELS),
                .DEAD         (DEAD),
                .WEIGHT_SHIFT (WEIGHT_SHIFT),
                .STRESS_BOUND (STRESS_BOUND),
                .ROM_DIR      (ROM_DIR),
                .ROM_NAME     (ROM_NAME)
            ) dead_taxels (
                .clock          (clock),
                .reset          (reset),
                .advance        (advance),
                .in_valid       (valid[STAGES]),
                .in_store       (stores[STAGES]),
                .in_last        (lasts[STAGES]),
                .in_bad_length  (bad_lengths[STAGES]),
                .in_stress      (read),
                .in_saturated   (read_saturated),
                .in_not_finite  (read_not_finite),
                .busy           (dead_busy),
                .out_valid      (whole_valid),
                .out_last       (whole_last),
                .out_bad_length (whole_bad_length),
                .out_stress     (fixed),
                .out_saturated  (saturated),
                .out_not_finite (not_finite),
                .replaced       (frame_replaced)
            );

            assign whole_store = 1'b1;
        end else begin : gen_as_read
            assign fixed = read;
            assign saturated = read_saturated;
            assign not_finite = read_not_finite;
            assign whole_valid = valid[STAGES];
            assign whole_store = stores[STAGES];
            assign whole_last = lasts[STAGES];
            assign whole_bad_length = bad_lengths[STAGES];
            assign dead_busy = 1'b0;
            assign frame_replaced = 30'd0;
            wire _unused = (WEIGHT_SHIFT != 0);
        end
    endgenerate

    // ---- Write
    wire taxel_valid = whole_valid && whole_store;
    generate
        if (WAYS == 4) begin : gen_fold
            sptfra_fold #(
                .COLUMNS     (COLUMNS),
                .ROWS        (ROWS),
                .STRESS_BITS (STRESS_BITS),
                .DATA_BITS   (DATA_BITS)
            ) fold (
                .clock         (clock),
                .reset         (reset),
                .advance       (advance),
                .in_valid      (whole_valid),
                .in_store      (whole_store),
                .in_last       (whole_last),
                .in_stress     (fixed[STRESS_BITS-1:0]),
                .write_valid   (write_valid),
                .write_bank    (write_bank),
                .write_quad    (write_row),
                .write_data    (write_data),
                .frame_written (frame_written)
            );
        end else begin : gen_taxels
            reg bank;
            reg [ROW_WIDTH-1:0] taxel;

            assign write_valid = taxel_valid;
            assign write_bank = bank;
            assign write_row = taxel;
            assign write_data = fixed[STRESS_BITS-1:0];
            assign frame_written = frame_done;

            always @(posedge clock) begin
                if (stress_valid) begin
                    taxel <= taxel + 1;
                end
                if (frame_done) begin
                    bank <= !bank;
                    taxel <= {ROW_WIDTH{1'b0}};
                end
                if (reset) begin
                    bank <= 1'b0;
                    taxel <= {ROW_WIDTH{1'b0}};
                end
            end
        end
    endgenerate

    // ---- Tell CeAn
    reg seen_saturated;
    reg seen_not_finite;

    assign stress_valid = taxel_valid && advance;
    assign stress = fixed;
    assign frame_done = whole_valid && whole_last && advance;
    assign frame_saturated = seen_saturated || (whole_store && saturated);
    assign frame_not_finite = seen_not_finite || (whole_store && not_finite);
    assign frame_bad_length = whole_bad_length;

    always @(posedge clock) begin
        if (stress_valid) begin
            seen_saturated <= frame_saturated;
            seen_not_finite <= frame_not_finite;
        end
        if (reset || frame_done) begin
            seen_saturated <= 1'b0;
            seen_not_finite <= 1'b0;
        end
    end

    // ---- Banks
    reg [1:0] frames_waiting;
    wire frame_opens = accept && !in_frame;

    assign frame_ready = (frames_waiting != 2'd0);

    always @(posedge clock) begin
        banks_taken <= banks_taken + {1'b0, frame_opens} - {1'b0, frame_release};
        frames_waiting <= frames_waiting + {1'b0, frame_written} - {1'b0, frame_start};
        if (reset) begin
            banks_taken <= 2'd0;
            frames_waiting <= 2'd0;
        end
    end

endmodule

`default_nettype wire
