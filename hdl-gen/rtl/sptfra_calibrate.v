// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts to stress in pascals, by gains and offsets in two banks of memory, of which one acts and the other is written:
// a stream of counts in, one of float32 out, for a Bz that takes pascals.
//
// A frame takes its gains and offsets from the bank that acts at its first beat, whatever happens meanwhile. Beat to
// beat: 18 cycles, one beat a cycle. Names end in the number of cycles since the beat came in. On the way readings go
// out and come back: at once, or when dead taxels among them are replaced (sptfra_replace).

`default_nettype none

module sptfra_calibrate #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // What a sample is: 0 float32, 1 a 16-bit integer, 2 one without a sign
    parameter SAMPLE = 0,
    // Largest magnitude of a count in fixed point: what reaches it is beyond the full scale by every gain
    parameter [26:0] NUMBER_BOUND = 27'd67108863,
    parameter OFFSET_BITS = 29,
    // Bits dropped of the product
    parameter COUNT_SHIFT = 14,
    // Full scale, less what rounding may take from it, and what a larger stress becomes
    parameter signed [47:0] FULL_SCALE = 48'sd51200000,
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // A step of the stress is 2^STRESS_LSB Pa
    parameter integer STRESS_LSB = -9,
    // Prefix of the names of the files with the content at power-up, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Cycles that the plan counts on, but for those of the readings' way; 0: any
    parameter EXPECTED_STAGES = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1
) (
    input  wire clock,
    input  wire reset,
    // Samples in
    input  wire [SAMPLE_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Stress out, float32; NaN for what is no number
    output wire [31:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready,
    // Banks
    input  wire active, // of the frames that begin
    output wire old_in_use, // the frame coming in began with the other one
    output wire frame_begins,
    output reg  bank_held, // of the frame that began last
    input  wire hold, // that frame is not whole yet: none may begin
    input  wire write_gain,
    input  wire write_offset,
    input  wire [TAXEL_WIDTH:0] address, // bank, taxel
    input  wire [27:0] write_gain_data, // exponent, mantissa
    input  wire [OFFSET_BITS-1:0] write_offset_data,
    output wire [27:0] gain,
    output wire [OFFSET_BITS-1:0] offset,
    // Each beat's stress, for tare
    input  wire tare_run,
    output wire reading_valid,
    output wire reading_marked, // of a frame that began with tare_run, high since then
    output wire reading_last,
    output wire [TAXEL_WIDTH-1:0] reading_taxel_8, // two cycles ahead
    output wire [TAXEL_WIDTH-1:0] reading_taxel,
    output wire signed [26:0] reading,
    output wire reading_bad, // clipped, no number, or of a frame of another length
    output wire reading_nan, // no number
    output wire reading_advance,
    // Readings as they come back
    input  wire back_valid,
    input  wire back_last,
    input  wire signed [26:0] back_stress,
    input  wire back_not_finite
);

    localparam INDEX_WIDTH = $clog2(TAXELS + 1);
    localparam STAGES = 17;
    localparam SKID = 1;
    localparam signed [47:0] HALF = (48'sd1 <<< COUNT_SHIFT) >>> 1;
    localparam [31:0] QUIET_NAN = 32'h7fc00000;
    localparam [31:0] LSB_WIDE = STRESS_LSB;
    localparam signed [9:0] LSB = LSB_WIDE[9:0];

    generate
        if ((EXPECTED_STAGES != 0) && (EXPECTED_STAGES != STAGES + SKID)) begin : gen_check_stages
            sptfra_error_the_plan_counts_on_other_stages invalid ();
        end
    endgenerate

    // ---- Which taxel, of which bank
    wire advance; // of the skid buffer behind, a register
    reg in_frame;
    reg marked_held;
    reg [INDEX_WIDTH-1:0] index; // of the next beat, stops at TAXELS
    reg [1:0] ends_inside; // last beats on their way: packets of a beat must not pile up here
    wire out_valid;
    wire out_last;
    wire end_leaves = out_valid && out_last && advance;
    wire bank = in_frame ? bank_held : active;
    wire marked = in_frame ? marked_held : tare_run;
    wire accept = s_tvalid && s_tready;
    wire [31:0] index_wide = {{(32-INDEX_WIDTH){1'b0}}, index};

    assign s_tready = advance && (in_frame || (!hold && (ends_inside != 2'd3)));
    assign frame_begins = accept && !in_frame;
    assign old_in_use = (in_frame || hold) && (bank_held != active);

    always @(posedge clock) begin
        if (accept) begin
            in_frame <= !s_tlast;
            bank_held <= bank;
            marked_held <= marked;
            index <= s_tlast ? {INDEX_WIDTH{1'b0}} : (index_wide != TAXELS) ? index + 1 : index;
        end
        ends_inside <= ends_inside + {1'b0, accept && s_tlast} - {1'b0, end_leaves};
        // What is left of a frame when its tare ends is none of the next one's
        if (!tare_run) begin
            marked_held <= 1'b0;
        end
        if (reset) begin
            in_frame <= 1'b0;
            bank_held <= 1'b0;
            marked_held <= 1'b0;
            index <= {INDEX_WIDTH{1'b0}};
            ends_inside <= 2'd0;
        end
    end

    wire [27:0] gain_1;
    wire [OFFSET_BITS-1:0] offset_1;

    sptfra_bank #(
        .WIDTH         (28),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_gains.mem"})
    ) gains (
        .clock        (clock),
        .write_enable (write_gain),
        .address      (address),
        .write_data   (write_gain_data),
        .data         (gain),
        .read_enable  (advance),
        .read_address ({bank, index_wide[TAXEL_WIDTH-1:0]}),
        .read_data    (gain_1)
    );

    sptfra_bank #(
        .WIDTH         (OFFSET_BITS),
        .ADDRESS_WIDTH (TAXEL_WIDTH + 1),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_bank_offsets.mem"})
    ) offsets (
        .clock        (clock),
        .write_enable (write_offset),
        .address      (address),
        .write_data   (write_offset_data),
        .data         (offset),
        .read_enable  (advance),
        .read_address ({bank, index_wide[TAXEL_WIDTH-1:0]}),
        .read_data    (offset_1)
    );

    // ---- Beside the numbers
    reg [STAGES:1] valid;
    reg [STAGES:1] lasts;
    reg [10:1] marks;
    reg [10:1] wrong_lengths; // beyond the last taxel, or the last beat before it
    reg [10*TAXEL_WIDTH-1:0] taxels; // of stages 10 to 1

    always @(posedge clock) begin
        if (advance) begin
            valid <= {valid[STAGES-1:11], back_valid, valid[9:1], accept};
            lasts <= {lasts[STAGES-1:11], back_last, lasts[9:1], s_tlast};
            marks <= {marks[9:1], marked};
            wrong_lengths <= {wrong_lengths[9:1], (index_wide == TAXELS) || (s_tlast && (index_wide != TAXELS - 1))};
            taxels <= {taxels[9*TAXEL_WIDTH-1:0], index_wide[TAXEL_WIDTH-1:0]};
        end
        if (!tare_run) begin
            marks <= 10'd0;
        end
        if (reset) begin
            valid <= {STAGES{1'b0}};
        end
    end

    // ---- Sample to a number: behind the memory stands a register
    reg [SAMPLE_BITS-1:0] sample_1;
    reg [SAMPLE_BITS-1:0] sample_2;
    reg signed [9:0] exponent_2;
    reg [6*18-1:0] mantissas; // of stages 7 to 2
    reg [7*OFFSET_BITS-1:0] offsets_to; // of stages 8 to 2
    wire signed [26:0] number_7;
    wire number_saturated_7;
    wire number_not_finite_7;

    always @(posedge clock) begin
        if (advance) begin
            sample_1 <= s_tdata;
            sample_2 <= sample_1;
            exponent_2 <= $signed(gain_1[27:18]);
            mantissas <= {mantissas[5*18-1:0], gain_1[17:0]};
            offsets_to <= {offsets_to[6*OFFSET_BITS-1:0], offset_1};
        end
    end

    generate
        if (SAMPLE == 0) begin : gen_float
            sptfra_float_to_fixed float_to_fixed (
                .clock      (clock),
                .enable     (advance),
                .float_bits (sample_2),
                .shift      (exponent_2),
                .limit      (NUMBER_BOUND),
                .fixed      (number_7),
                .saturated  (number_saturated_7),
                .not_finite (number_not_finite_7)
            );
        end else begin : gen_integer
            sptfra_int_to_fixed #(
                .SIGNED ((SAMPLE == 1) ? 1 : 0)
            ) int_to_fixed (
                .clock     (clock),
                .enable    (advance),
                .count     (sample_2),
                .shift     (exponent_2),
                .limit     (NUMBER_BOUND),
                .fixed     (number_7),
                .saturated (number_saturated_7)
            );

            assign number_not_finite_7 = 1'b0;
        end
    endgenerate

    // ---- Product, sum, clipping
    wire signed [44:0] product_low_8; // the product is their sum
    wire signed [44:0] product_high_8;
    wire signed [47:0] product_half = {{3{product_low_8[44]}}, product_low_8}
        + {{3{product_high_8[44]}}, product_high_8} + HALF;
    wire [OFFSET_BITS-1:0] offset_8 = offsets_to[7*OFFSET_BITS-1 -: OFFSET_BITS];
    wire signed [47:0] offset_wide_8 = {{(48-OFFSET_BITS){offset_8[OFFSET_BITS-1]}}, offset_8};
    reg signed [47:0] sum_9;
    reg signed [26:0] stress_10;
    reg clipped_10;
    reg [STAGES:8] not_finite;
    wire above = (sum_9 >= FULL_SCALE);
    wire below = (sum_9 <= -FULL_SCALE);

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (advance),
        .coefficient (mantissas[6*18-1 -: 18]),
        .data        (number_7),
        .low         (product_low_8),
        .high        (product_high_8)
    );

    always @(posedge clock) begin
        if (advance) begin
            sum_9 <= (product_half >>> COUNT_SHIFT) + offset_wide_8;
            stress_10 <= above ? STRESS_BOUND : below ? -STRESS_BOUND : sum_9[26:0];
            clipped_10 <= above || below;
            not_finite <= {not_finite[STAGES-1:11], back_not_finite, not_finite[9:8], number_not_finite_7};
        end
    end

    assign reading_valid = valid[10];
    assign reading_marked = marks[10];
    assign reading_last = lasts[10];
    assign reading_taxel_8 = taxels[8*TAXEL_WIDTH-1 -: TAXEL_WIDTH];
    assign reading_taxel = taxels[10*TAXEL_WIDTH-1 -: TAXEL_WIDTH];
    assign reading = stress_10;
    assign reading_bad = clipped_10 || not_finite[10] || wrong_lengths[10];
    assign reading_nan = not_finite[10];
    assign reading_advance = advance;

    // ---- Out, as float32
    wire [31:0] float_17;

    assign out_valid = valid[STAGES];
    assign out_last = lasts[STAGES];

    sptfra_fixed_to_float fixed_to_float (
        .clock      (clock),
        .enable     (advance),
        .fixed      ({{37{back_stress[26]}}, back_stress}),
        .exponent   (LSB),
        .float_bits (float_17)
    );

    sptfra_axis_skid skid (
        .clock    (clock),
        .reset    (reset),
        .s_tdata  (not_finite[STAGES] ? QUIET_NAN : float_17),
        .s_tlast  (out_last),
        .s_tvalid (out_valid),
        .s_tready (advance),
        .m_tdata  (m_tdata),
        .m_tlast  (m_tlast),
        .m_tvalid (m_tvalid),
        .m_tready (m_tready)
    );

    // A number at its bound is beyond the full scale by every gain that a bank takes
    wire _unused = &{1'b0, number_saturated_7, index_wide, LSB_WIDE};

endmodule

`default_nettype wire
